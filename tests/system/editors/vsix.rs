//! The extension of VS Code as one file, which its users install: a zip whose bytes follow from its contents. The test writes it to
//! `target/psd.vsix` and needs no network. The format is that of the Open Packaging Conventions: two XML files beside `extension/`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::folder;
use crate::needs;

/// The files of the extension, by their paths in `vscode/`. Sources of the bundle, tests and the lock file are not among them.
const FILES: &[&str] = &[
    "package.json",
    "README.md",
    "language-configuration.json",
    "snippets/psd.json",
    "syntaxes/markdown.json",
    "syntaxes/psd.tmLanguage.json",
    "dist/extension.js",
    "dist/LICENSES.txt",
];

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="utf-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension=".json" ContentType="application/json"/><Default Extension=".js" ContentType="application/javascript"/><Default Extension=".md" ContentType="text/markdown"/><Default Extension=".txt" ContentType="text/plain"/><Default Extension=".vsixmanifest" ContentType="text/xml"/></Types>
"#;

/// What the editor reads before it opens the extension.
fn manifest(package: &Value) -> String {
    let text = |key: &str| package[key].as_str().expect("a text").to_owned();
    let (name, title, about) = (text("name"), text("displayName"), text("description"));
    let (publisher, version) = (text("publisher"), text("version"));
    let engine = package["engines"]["vscode"].as_str().expect("a version");
    format!(
        r#"<?xml version="1.0" encoding="utf-8"?>
<PackageManifest Version="2.0.0" xmlns="http://schemas.microsoft.com/developer/vsx-schema/2011">
  <Metadata>
    <Identity Language="en-US" Id="{name}" Version="{version}" Publisher="{publisher}"/>
    <DisplayName>{title}</DisplayName>
    <Description xml:space="preserve">{about}</Description>
    <Categories>Programming Languages,Snippets,Formatters</Categories>
    <Properties>
      <Property Id="Microsoft.VisualStudio.Code.Engine" Value="{engine}"/>
      <Property Id="Microsoft.VisualStudio.Code.ExtensionKind" Value="workspace"/>
    </Properties>
    <License>extension/LICENSE.txt</License>
  </Metadata>
  <Installation>
    <InstallationTarget Id="Microsoft.VisualStudio.Code"/>
  </Installation>
  <Dependencies/>
  <Assets>
    <Asset Type="Microsoft.VisualStudio.Code.Manifest" Path="extension/package.json" Addressable="true"/>
    <Asset Type="Microsoft.VisualStudio.Services.Content.Details" Path="extension/README.md" Addressable="true"/>
    <Asset Type="Microsoft.VisualStudio.Services.Content.License" Path="extension/LICENSE.txt" Addressable="true"/>
  </Assets>
</PackageManifest>
"#
    )
}

/// A zip of stored files, all of 1 January 1980, the first day that the format knows.
fn zip(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    const DAY: u16 = 1 << 5 | 1;
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in files {
        let number = |number: usize| u32::try_from(number).expect("a small file").to_le_bytes();
        let length = u16::try_from(name.len())
            .expect("a short name")
            .to_le_bytes();
        let start = number(bytes.len());
        // Version 2.0, names in UTF-8, stored, midnight.
        let mut common = [20_u16, 1 << 11, 0, 0, DAY].map(u16::to_le_bytes).concat();
        common.extend(crc32fast::hash(content).to_le_bytes());
        common.extend([number(content.len()), number(content.len())].concat());
        common.extend(length);
        common.extend([0, 0]);
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&common);
        bytes.extend(name.as_bytes());
        bytes.extend(content);
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(start);
        directory.extend(name.as_bytes());
    }
    let count = u16::try_from(files.len()).expect("few files").to_le_bytes();
    let sizes = [directory.len(), bytes.len()];
    bytes.extend(&directory);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend([count, count].concat());
    bytes.extend(
        sizes
            .map(|size| u32::try_from(size).expect("small").to_le_bytes())
            .concat(),
    );
    bytes.extend([0, 0]);
    bytes
}

fn package() -> Value {
    let page = fs::read(folder().join("package.json")).expect("the manifest is there");
    serde_json::from_slice(&page).expect("JSON")
}

fn contents() -> Vec<(String, Vec<u8>)> {
    let package = package();
    let bytes = |path: PathBuf| {
        fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let license = bytes(Path::new(env!("CARGO_MANIFEST_DIR")).join("LICENSE"));
    let mut files = vec![
        ("[Content_Types].xml".to_owned(), CONTENT_TYPES.into()),
        (
            "extension.vsixmanifest".to_owned(),
            manifest(&package).into(),
        ),
        ("extension/LICENSE.txt".to_owned(), license),
    ];
    for name in FILES {
        files.push((format!("extension/{name}"), bytes(folder().join(name))));
    }
    files
}

#[test]
fn the_extension_is_written_as_one_file() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/psd.vsix");
    fs::write(&path, zip(&contents())).expect("the file can be written");
    if !needs::python() {
        return;
    }
    let read = "import sys, zipfile\n\
                z = zipfile.ZipFile(sys.argv[1])\n\
                assert z.testzip() is None\n\
                for name in z.namelist()[3:]:\n \
                assert z.read(name) == open(name.replace('extension/', sys.argv[2] + '/', 1), 'rb').read()\n";
    let mut python = Command::new("python3");
    let status = python.args(["-c", read]).arg(path).arg(folder()).status();
    assert!(status.expect("python3 runs").success());
}

/// The version is that of psd, and every file that the manifest of the extension names is in the archive.
#[test]
fn the_extension_has_what_it_names() {
    let package = package();
    assert_eq!(package["version"], env!("CARGO_PKG_VERSION"));
    let main = package["main"].as_str().map(str::to_owned);
    let contributed = package["contributes"].as_object().expect("an object");
    let entries = contributed.values().filter_map(Value::as_array).flatten();
    let named = entries.flat_map(|entry| [&entry["path"], &entry["configuration"]]);
    let named = named.filter_map(|path| path.as_str().map(str::to_owned));
    let named: BTreeSet<String> = named.chain(main).collect();
    assert_eq!(named.len(), 5, "{named:?}");
    for name in named {
        assert!(FILES.contains(&name.as_str()), "{name}");
    }
}
