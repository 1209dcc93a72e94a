//! The first messages of editors. Those of VS Code (code-server 1.139) and Neovim were recorded; those of Helix and Zed are condensed from
//! their sources. Then the conversation goes on as theirs does.

use serde_json::{Value, json};

use super::testing::{Editor, uri};

/// An editor, its first message, and the encoding of positions that it gets.
const EDITORS: [(&str, &str, &str); 4] = [
    ("neovim", include_str!("editors/neovim.json"), "utf-16"),
    ("vscode", include_str!("editors/vscode.json"), "utf-16"),
    ("helix", include_str!("editors/helix.json"), "utf-8"),
    ("zed", include_str!("editors/zed.json"), "utf-16"),
];

#[test]
fn the_first_message_of_each_editor_is_understood() {
    for (name, text, encoding) in EDITORS {
        let message: Value =
            serde_json::from_str(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut editor = Editor::before_initialize(&[("lib/s.psd", "let s = 1 mx\n")]);
        let answer = editor.ask("initialize", message["params"].clone());
        let found = answer["capabilities"]["positionEncoding"].as_str();
        assert_eq!(found, Some(encoding), "{name}");
        editor.notify("initialized", json!({}));
        editor.notify(
            "workspace/didChangeConfiguration",
            json!({ "settings": {} }),
        );
        editor.open("a.psd", "use \"lib/s.psd\"\nlet a = s\n");
        let published = editor.diagnostics("lib/s.psd");
        assert_eq!(published["diagnostics"][0]["code"], "E204", "{name}");
        let hover = json!({ "textDocument": { "uri": uri("a.psd") }, "position": { "line": 1, "character": 4 } });
        assert!(
            editor.ask("textDocument/hover", hover)["contents"]["value"].is_string(),
            "{name}"
        );
        let watches = message["params"]["capabilities"]["workspace"]["didChangeWatchedFiles"]["dynamicRegistration"]
            == true;
        if watches {
            editor.was_asked("client/registerCapability");
        } else {
            assert!(editor.asked.is_empty(), "{name}: {:?}", editor.asked);
        }
    }
}
