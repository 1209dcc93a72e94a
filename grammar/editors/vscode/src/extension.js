// The client of `psd lsp`, and the task that checks a plan. It knows no word of the language: the server does.

const vscode = require('vscode');
const { LanguageClient } = require('vscode-languageclient/node');

/** The file of the active editor, as tasks name it. */
const OPEN_PLAN = '${file}';

let client;

const program = () => vscode.workspace.getConfiguration('psd').get('path', 'psd');

/** A document that the server reads: a plan, or a Markdown document with a `psd` block. */
const isPlan = document =>
  document.languageId === 'psd' || (document.languageId === 'markdown' && /^\s*[`~]{3,}\s*psd\b/m.test(document.getText()));

/** The server starts with the first plan. */
async function startForPlan(document) {
  if (!client && isPlan(document)) {
    await start();
  }
}

async function start() {
  const server = { command: program(), args: ['lsp'] };
  client = new LanguageClient('psd', 'psd', server, {
    documentSelector: [{ language: 'psd' }, { language: 'markdown', scheme: 'file' }],
  });
  try {
    await client.start();
  } catch {
    // The client has shown the reason.
    const set = 'Set its path';
    const answer = await vscode.window.showWarningMessage(`${program()} lsp does not start.`, set);
    if (answer === set) {
      await vscode.commands.executeCommand('workbench.action.openSettings', 'psd.path');
    }
  }
}

async function stop() {
  const running = client;
  client = undefined;
  // A server that did not start has nothing to stop.
  await running?.stop().catch(() => {});
}

/** `psd check` of one plan; its diagnostics appear among the problems. */
function checkTask(definition, scope) {
  const check = new vscode.ShellExecution(program(), ['check', '--format', 'json', definition.plan]);
  const name = definition.plan === OPEN_PLAN ? 'check the open plan' : `check ${definition.plan}`;
  const task = new vscode.Task(definition, scope, name, 'psd', check, '$psd');
  task.group = vscode.TaskGroup.Build;
  task.presentationOptions = { reveal: vscode.TaskRevealKind.Never };
  return task;
}

const tasks = {
  provideTasks() {
    return [checkTask({ type: 'psd', plan: OPEN_PLAN }, vscode.TaskScope.Workspace)];
  },
  resolveTask(task) {
    return checkTask(task.definition, task.scope ?? vscode.TaskScope.Workspace);
  },
};

async function activate(context) {
  context.subscriptions.push(
    vscode.tasks.registerTaskProvider('psd', tasks),
    vscode.workspace.onDidChangeConfiguration(async change => {
      if (client && change.affectsConfiguration('psd.path')) {
        await stop();
        await start();
      }
    }),
    vscode.workspace.onDidOpenTextDocument(startForPlan),
  );
  await Promise.all(vscode.workspace.textDocuments.map(startForPlan));
}

module.exports = { activate, deactivate: stop };
