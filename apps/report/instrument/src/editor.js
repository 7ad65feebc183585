// The editor: YAML with highlighting, completion and help from the schema, and mistakes where they are.
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, snippet } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { yamlLanguage } from "@codemirror/lang-yaml";
import { HighlightStyle, LanguageSupport, bracketMatching, indentOnInput, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { EditorState } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, highlightActiveLineGutter, hoverTooltip, keymap, lineNumbers, tooltips } from "@codemirror/view";
import { NodeType, Tree } from "@lezer/common";
import { tags } from "@lezer/highlight";
import { element } from "../../src/element.js";
import { Schema, context } from "./schema.js";

/** Keys whose values are names of the spec itself: of coordinates, links, parameters. */
const NAMES = { coordinate: "coordinates", follows: "coordinates", link: "links", load: "parameters" };
/** Mappings at the top of a spec whose keys are such names. */
const KEYED = { armature: "coordinates", damping: "coordinates", friction: "coordinates", guess: "coordinates", stops: "coordinates" };

/** Whole entries of lists at the top of a spec: the first word of each completion, and its text. */
export const ENTRIES = {
  links: ["link", "- name: ${1:link}\n  placement: {transform: {translation: [${2:1}, 0, 0]}}\n  joint: {revolute: {axis: ${3:y}}}\n  mass: ${4:100}\n  com: [${5:0.5}, 0, 0]\n  inertia: {gyration: [0.1, 0.3, 0.3]}"],
  drives: ["drive", "- coordinate: ${1:coordinate}\n  stiffness: ${2:1e6}\n  damping: ${3:1e4}\n  motion: {hold: ${4:0 deg}}"],
  points: ["point", "- {name: ${1:point}, link: ${2:link}, at: [${3:0}, 0, 0]}"],
  supports: ["support", "- {name: ${1:foot}, one_sided: true, at: [${2:1}, ${3:1}, ${4:-1}], stiffness: [4e6, 4e6, 1.2e7], damping: [4e4, 4e4, 9e4]}"],
};

const colours = HighlightStyle.define([
  { tag: [tags.definition(tags.propertyName), tags.propertyName], color: "var(--code-key)" },
  { tag: [tags.string, tags.special(tags.string)], color: "var(--code-text)" },
  { tag: [tags.number, tags.bool, tags.null, tags.atom], color: "var(--code-number)" },
  { tag: [tags.comment, tags.lineComment], color: "var(--code-comment)" },
  { tag: [tags.punctuation, tags.separator, tags.squareBracket, tags.brace], color: "var(--soft)" },
  { tag: tags.invalid, color: "var(--bad)" },
]);

/** The parser builds its tree by recursion: a text that is nested too deeply for the browser's stack stays without colours. */
const wrap = (parse, input) => ({
  advance() {
    try {
      return parse.advance();
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      return new Tree(NodeType.none, [], [], input.length);
    }
  },
  get parsedPos() {
    return parse.parsedPos;
  },
  get stoppedAt() {
    return parse.stoppedAt;
  },
  stopAt(position) {
    parse.stopAt(position);
  },
});
const yaml = new LanguageSupport(yamlLanguage.configure({ wrap }));

const look = EditorView.theme({
  "&": { height: "100%", fontSize: "13px", color: "var(--ink)", backgroundColor: "var(--card)" },
  "&.cm-focused": { outline: "none" },
  ".cm-scroller": { fontFamily: 'ui-monospace, "Cascadia Mono", Menlo, "DejaVu Sans Mono", monospace', lineHeight: "1.5" },
  ".cm-gutters": { backgroundColor: "var(--card)", color: "var(--soft)", border: "0" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "color-mix(in srgb, var(--accent) 7%, transparent)" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { background: "color-mix(in srgb, var(--accent) 25%, transparent) !important" },
  ".cm-tooltip": { backgroundColor: "var(--card)", color: "var(--ink)", border: "1px solid var(--line)", borderRadius: "8px", maxWidth: "min(32rem, 88vw)", boxShadow: "0 4px 18px #0003" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { background: "var(--accent)", color: "var(--card)" },
  ".cm-completionInfo": { whiteSpace: "pre-wrap", padding: "6px 9px", font: "13px/1.45 system-ui, sans-serif" },
  ".cm-help": { whiteSpace: "pre-wrap", padding: "6px 10px", font: "13px/1.45 system-ui, sans-serif" },
  ".cm-diagnostic": { whiteSpace: "pre-wrap", padding: "5px 10px", font: "13px/1.45 system-ui, sans-serif" },
  ".cm-panels": { backgroundColor: "var(--paper)", color: "var(--ink)" },
});

/** Where a line and a column, both from 1, are in a document. */
function offset(doc, line, column) {
  const found = doc.line(Math.min(Math.max(line, 1), doc.lines));
  // Columns count characters, offsets UTF-16.
  const before = [...found.text].slice(0, Math.max(column - 1, 0)).join("");
  return Math.min(found.from + before.length, doc.length);
}

export class Editor {
  /** `changed(text)` is called after every change; `names()` returns what the crane's parts are called. */
  constructor(host, schema, { changed, names }) {
    this.schema = new Schema(schema);
    this.names = names;
    // Styles of a shadow root are sheets of its own: the page's policy forbids elements of style.
    const root = host.attachShadow({ mode: "open" });
    const parent = element("div", { className: "editor" });
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(".editor { height: 100%; } .cm-editor { height: 100%; }");
    root.adoptedStyleSheets = [sheet];
    root.append(parent);
    const extensions = [
      lineNumbers(), highlightActiveLine(), highlightActiveLineGutter(), history(), drawSelection(), indentOnInput(), bracketMatching(), closeBrackets(),
      highlightSelectionMatches(), yaml, indentUnit.of("  "), syntaxHighlighting(colours), look, lintGutter(), tooltips({ position: "fixed" }),
      EditorState.tabSize.of(2), EditorView.contentAttributes.of({ "aria-label": "Spec of the crane, YAML", spellcheck: "false" }),
      autocompletion({ override: [(state) => this.complete(state)], icons: false }),
      hoverTooltip((view, position) => this.help(view, position), { hoverTime: 350 }),
      EditorView.updateListener.of((update) => update.docChanged && changed(this.text)),
      // Tab indents; Escape, then Tab, leaves the editor.
      keymap.of([...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...completionKeymap, ...lintKeymap, indentWithTab]),
    ];
    this.view = new EditorView({ root, parent, state: EditorState.create({ extensions }) });
  }

  get text() {
    return this.view.state.doc.toString();
  }

  set text(text) {
    const { view } = this;
    view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text }, selection: { anchor: 0 }, scrollIntoView: true });
  }

  /** Underlines mistakes and warnings of this file; the others have no place in it. */
  mark(diagnostics, file) {
    const { state } = this.view;
    const marks = diagnostics.filter((one) => one.file === file).map(({ code, severity, line, column, end_line: endLine, end_column: endColumn, message, label, help }) => {
      const from = offset(state.doc, line, column);
      const to = Math.max(offset(state.doc, endLine, endColumn), from);
      const text = [`${message} [${code}]`, label, help && `help: ${help}`].filter(Boolean).join("\n");
      return { from, to: to === from ? Math.min(from + 1, state.doc.length) : to, severity, message: text };
    });
    this.view.dispatch(setDiagnostics(state, marks));
  }

  /** Goes to a line and a column, both from 1. */
  show(line, column) {
    this.go(offset(this.view.state.doc, line, column));
  }

  /** What a key would be in the mapping at a line and a column. */
  about(line, column, key) {
    const { doc } = this.view.state;
    const at = offset(doc, line, column);
    const text = doc.toString();
    const { path } = context(text, text[at] === "{" ? at + 1 : at);
    // The place is in the mapping, or at a value in it.
    return this.schema.about([...path, key]) || this.schema.about([...path.slice(0, -1), key]);
  }

  /** Changes of the text, `{from, to, insert}`. */
  change(changes) {
    this.view.dispatch({ changes });
  }

  /** Goes to a place. */
  go(anchor) {
    this.view.dispatch({ selection: { anchor }, effects: EditorView.scrollIntoView(anchor, { y: "center" }) });
    this.view.focus();
  }

  complete({ state, pos, explicit }) {
    const before = state.sliceDoc(state.doc.lineAt(pos).from, pos);
    if (/(^|\s)#/.test(before)) return null;
    const word = /[\w./-]*$/.exec(before)[0];
    if (!word && !explicit) return null;
    const from = pos - word.length;
    const { path, key } = context(state.sliceDoc(0, from), from);
    const entry = this.entry(before, path, from);
    if (entry && !key) return { from, options: [entry], validFor: /^\w*$/ };
    if (key) {
      const follows = state.sliceDoc(pos, pos + 1) === ":";
      const own = path.length === 1 ? (this.names()[KEYED[path[0]]] ?? []) : [];
      const keys = [...own.map((name) => [name]), ...this.schema.keys(path)].map(([name, info]) => ({ label: name, apply: follows ? name : `${name}: `, type: "property", info: info || undefined }));
      const options = [...(entry ? [entry] : []), ...keys];
      return options.length ? { from, options, validFor: /^\w*$/ } : null;
    }
    const words = [...this.schema.values(path)].map(([label, info]) => ({ label, type: "constant", info: info || undefined }));
    const names = this.names();
    const own = (names[NAMES[path.at(-1)]] ?? (words.length ? [] : names.parameters)).map((label) => ({ label, type: "variable" }));
    const options = [...words, ...own];
    return options.length ? { from, options, validFor: /^[\w-]*$/ } : null;
  }

  /** A whole entry of the list at a path, where one may begin after `before`. */
  entry(before, [list, item, ...more], from) {
    const dash = /^\s*(-\s+)?\w*$/.exec(before);
    if (!ENTRIES[list] || more.length || !dash || Boolean(dash[1]) !== (item === "[]")) return null;
    const [label, text] = ENTRIES[list];
    const apply = (view, completion, _, to) => snippet(text)(view, completion, from - (dash[1]?.length ?? 0), to);
    return { label, detail: "a whole entry", type: "class", boost: 1, apply };
  }

  help(view, position) {
    const { doc } = view.state;
    const line = doc.lineAt(position);
    const at = position - line.from;
    const begin = at - /[\w]*$/.exec(line.text.slice(0, at))[0].length;
    const end = at + /^[\w]*/.exec(line.text.slice(at))[0].length;
    if (begin === end || /(^|\s)#/.test(line.text.slice(0, begin))) return null;
    const { path, key } = context(doc.sliceString(0, line.from + begin), line.from + begin);
    const word = line.text.slice(begin, end);
    const about = key ? this.schema.about([...path, word]) : this.schema.values(path).get(word);
    if (!about) return null;
    const dom = () => ({ dom: element("div", { className: "cm-help", textContent: about }) });
    return { pos: line.from + begin, end: line.from + end, above: true, create: dom };
  }
}
