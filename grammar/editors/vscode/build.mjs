// Writes the client with its libraries as one file, dist/extension.js, and the licences of these libraries beside it. `--check` compares
// instead. `npm ci --ignore-scripts` comes before, from the lock file, so that the bytes are the same everywhere.

import { build } from 'esbuild';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const here = fileURLToPath(new URL('.', import.meta.url));

const { outputFiles, metafile } = await build({
  entryPoints: ['src/extension.js'],
  outfile: 'dist/extension.js',
  absWorkingDir: here,
  bundle: true,
  platform: 'node',
  target: 'node20',
  format: 'cjs',
  external: ['vscode'],
  minify: true,
  legalComments: 'none',
  metafile: true,
  write: false,
});

const packages = new Set(Object.keys(metafile.inputs).flatMap(path => path.match(/node_modules\/(?:@[^/]+\/)?[^/]+/) ?? []));
const licenses = [...packages].sort().map(folder => {
  const path = name => `${here}${folder}/${name}`;
  const { name, version, license } = JSON.parse(readFileSync(path('package.json')));
  const file = ['LICENSE', 'LICENSE.md', 'LICENSE.txt', 'License.txt'].map(path).find(existsSync);
  if (!file) {
    throw new Error(`${name} has no licence file`);
  }
  const text = readFileSync(file, 'utf8').replaceAll('\r', '').trim();
  return `${name} ${version}: ${license}\n\n${text}\n`;
});

const files = {
  'dist/extension.js': outputFiles[0].text,
  'dist/LICENSES.txt': `dist/extension.js contains these packages.\n\n${licenses.join(`\n${'-'.repeat(80)}\n\n`)}`,
};
let behind = false;
for (const [name, wanted] of Object.entries(files)) {
  const path = `${here}${name}`;
  if (!process.argv.includes('--check')) {
    writeFileSync(path, wanted);
  } else if (!existsSync(path) || readFileSync(path, 'utf8') !== wanted) {
    console.error(`${name} is behind its source: npm ci --ignore-scripts && node build.mjs`);
    behind = true;
  }
}
process.exitCode = behind ? 1 : 0;
