import "../tube-viewer.ts";
import { askWhereWanted, heedKey } from "../key.ts";
import { TubeViewer, type TubeEvents } from "../viewer/element.ts";
import { keyOf, type ThingName } from "../viewer/things.ts";
import { copy, curlOf, fileOf } from "./curl.ts";
import { open } from "./documents.ts";
import { Downloads } from "./downloads.ts";
import { takeFiles } from "./dropping.ts";
import { contentsOf, DEFAULT_EXAMPLE, EXAMPLES } from "./examples.ts";
import { fragmentOf, read } from "./link.ts";
import { Options } from "./options.ts";
import { calm, part, say, warn } from "./page.ts";
import { idsOf, parse, rangeOfThing, thingAt, valueAt, type Parsed, type Range } from "./places.ts";
import { place } from "./popovers.ts";
import { Problems } from "./problems.ts";
import { rewrite } from "./rewriting.ts";
import { service, troubleOf } from "./service.ts";
import { share } from "./split.ts";
import { Stills, type Quality } from "./stills.ts";
import { ProgramText } from "./text.ts";
import { switchTheme } from "./theme.ts";
import { countsOf, verdictOf } from "./verdict.ts";

const KEPT = "tubeloom.text";
const TYPING_MILLISECONDS = 150;
/** So long the editor waits for the first picture, which comes sooner without it. */
const PATIENCE_MILLISECONDS = 1500;
const DRAWING_MILLISECONDS = { interactive: 0, draft: 250, final: 900 };

const viewer = part("tube-viewer", TubeViewer);
const verdict = part("#verdict", HTMLElement);
const counts = part("#counts", HTMLElement);
const examples = part("#example", HTMLSelectElement);
const optionsBox = part("#options", HTMLElement);

/** The text as it is now, what is right in it or not. */
let parsed: Parsed = parse("");
/** The last text that could be shown. */
let shown = "";
let isKept = false;
let view: readonly [number, number, number] | undefined;

const editor = new ProgramText(part("#editor", HTMLElement), {
  change(text, isTyped) {
    parsed = parse(text);
    problems.show(parsed);
    if (optionsBox.matches(":popover-open")) options.show(parsed);
    if (!isTyped) return;
    examples.value = "";
    if (isKept) localStorage.setItem(KEPT, text);
    showSoon();
  },
  cursor: () => selectInPicture(),
});
const problems = new Problems(editor, part("#summary", HTMLElement), part("#list", HTMLElement));
const options = new Options(optionsBox, (path, value) => {
  if (parsed.errors.length > 0) {
    warn("The text must be right before options can be written into it.");
    return;
  }
  editor.apply(rewrite(parsed, path, value));
  if (path[0] === "view") view = viewOf(parsed);
});
const stills = new Stills(
  {
    image: part("#still", HTMLImageElement),
    drawing: part("#drawing", HTMLElement),
    doing: part("#doing", HTMLElement),
    share: part("#share", HTMLProgressElement),
    cancel: part("#cancel", HTMLButtonElement),
    again: part("#again", HTMLButtonElement),
  },
  () => draw(),
  warn,
);
new Downloads(part("#downloads", HTMLElement), () => ({
  text: editor.text,
  name: valueAt(parsed, ["name"]),
  picture: stills.quality === "final" ? stills.query(...size()) : `format=png&${stills.query(...size()).replace(/^format=\w+&/, "")}`,
}));

function size(): [number, number] {
  return [Math.max(viewer.clientWidth, 64), Math.max(viewer.clientHeight, 64)];
}

function show(): void {
  if (parsed.errors.length > 0) return;
  shown = parsed.text;
  viewer.program = shown;
  drawSoon[stills.quality]();
}
const showSoon = calm(show, TYPING_MILLISECONDS);

function draw(): void {
  void stills.draw(shown, ...size());
}
const drawSoon = {
  interactive: () => undefined,
  draft: calm(draw, DRAWING_MILLISECONDS.draft),
  final: calm(draw, DRAWING_MILLISECONDS.final),
};

function viewOf(of: Parsed): readonly [number, number, number] {
  if (valueAt(of, ["layout", "dimensions"]) === 2) return [0, 0, 1];
  const from = valueAt(of, ["view", "from"]);
  return Array.isArray(from) ? (from as unknown as [number, number, number]) : [0.2, -1, 1];
}

/** Put a document in place of the text, and show it from where it says. */
function put(text: string, example = ""): void {
  warn(undefined);
  editor.text = text;
  examples.value = example;
  problems.problem = undefined;
  problems.clearance = undefined;
  problems.show(parsed);
  // The viewer itself takes its first view from the document.
  view = shown === "" ? undefined : viewOf(parsed);
  if (view && text === shown) viewer.look(view);
  show();
}

async function openExample(name: string): Promise<void> {
  const example = EXAMPLES.find((each) => each.name === name);
  if (example === undefined) throw new Error(`There is no example ${name}.`);
  put(await open(await contentsOf(example)), name);
}

/** Do it, and tell if it goes wrong. */
async function attempt(act: () => Promise<void>): Promise<void> {
  try {
    await act();
  } catch (error) {
    warn(troubleOf(error));
  }
}

/** Begin with what the address asks for, else with what was typed last, else with an example. */
async function begin(): Promise<void> {
  const kept = localStorage.getItem(KEPT);
  try {
    const asked = await read(location.hash);
    isKept = asked === undefined;
    if (asked && "program" in asked) put(asked.program);
    else if (asked) await openExample(asked.example);
    else if (kept) put(kept);
    else await openExample(DEFAULT_EXAMPLE);
  } catch (error) {
    await attempt(() => openExample(DEFAULT_EXAMPLE));
    warn(troubleOf(error));
  }
}

/** Have the editor come once there is a picture, or will be none. */
function enrichAfterwards(): void {
  const enrich = () => editor.enrich();
  setTimeout(enrich, PATIENCE_MILLISECONDS);
  viewer.addEventListener("tube-problem", enrich, { once: true });
  viewer.addEventListener(
    "tube-load",
    () => void viewer.drawn().then(() => requestAnimationFrame(() => setTimeout(enrich))),
    { once: true },
  );
}

function selectInPicture(): void {
  const drawn = new Set(viewer.things.map(keyOf));
  const things = editor.cursors.map((offset) => thingAt(parsed, offset));
  // While the text is broken, it may speak of what the picture does not have yet.
  viewer.selection = things.filter((thing): thing is ThingName => thing !== undefined && drawn.has(keyOf(thing)));
}

function on<Name extends keyof TubeEvents>(name: Name, act: (detail: TubeEvents[Name]) => void): void {
  viewer.addEventListener(name, (event) => act((event as CustomEvent<TubeEvents[Name]>).detail));
}

on("tube-load", (detail) => {
  problems.problem = undefined;
  problems.show(parsed);
  viewer.classList.remove("refused");
  counts.textContent = countsOf(detail);
  if (valueAt(parsed, ["layout", "clearance"]) === null) tell("none", "Distances are not looked at.");
  else if (verdict.textContent === "") tell("none", "Looking at distances …");
  else verdict.classList.add("old");
  const name = valueAt(parsed, ["name"]);
  document.title = typeof name === "string" && name ? `${name} · Tubeloom` : "Tubeloom";
  if (view) viewer.look(view);
  view = undefined;
  selectInPicture();
});
on("tube-problem", ({ problem }) => {
  // A missing key is nothing that is wrong with the text.
  const isOfText = problem.status !== 401;
  problems.problem = isOfText ? problem : undefined;
  problems.show(parsed);
  viewer.classList.toggle("refused", isOfText);
  verdict.classList.add("old");
});
on("tube-clearance", ({ clearance }) => {
  problems.clearance = clearance;
  problems.show(parsed);
  const { verdict: kind, text } = verdictOf(clearance, idsOf(parse(shown), "hyperedge").length);
  tell(kind, text);
});
on("tube-select", ({ things }) => {
  const ranges = things.map((thing) => rangeOfThing(parsed, thing));
  editor.select(ranges.filter((range): range is Range => range !== undefined));
});

function tell(kind: "none" | "good" | "bad", text: string): void {
  verdict.classList.remove("old");
  verdict.dataset["verdict"] = kind;
  if (verdict.textContent !== text) verdict.textContent = text;
  verdict.title = text;
}

async function copied(button: HTMLButtonElement, what: string, text: () => string | Promise<string>): Promise<void> {
  try {
    await copy(await text());
    say(`${what} is on the clipboard.`);
    button.classList.add("done");
    setTimeout(() => button.classList.remove("done"), 1500);
  } catch (error) {
    warn(troubleOf(error));
  }
}

const copyCurl = part("#copy-curl", HTMLButtonElement);
copyCurl.addEventListener("click", () => {
  const file = fileOf(valueAt(parsed, ["name"]), stills.quality === "interactive" ? "glb" : "png");
  void copied(copyCurl, "The command", () => curlOf(location.origin, stills.query(...size()), file, editor.text, service.key !== undefined));
});
const copyLink = part("#copy-link", HTMLButtonElement);
copyLink.addEventListener("click", () => {
  void copied(copyLink, "The link", async () => {
    const fragment = examples.value ? `#example=${examples.value}` : await fragmentOf(editor.text);
    history.replaceState(null, "", fragment);
    return location.href;
  });
});

examples.append(new Option("Example …", ""), ...EXAMPLES.map(({ name, title }) => new Option(title, name)));
examples.addEventListener("change", () => {
  if (examples.value) void attempt(() => openExample(examples.value));
});
part("#quality", HTMLFieldSetElement).addEventListener("change", (event) => {
  warn(undefined);
  stills.quality = (event.target as HTMLInputElement).value as Quality;
  document.body.dataset["quality"] = stills.quality;
  draw();
});
part("#notice button", HTMLButtonElement).addEventListener("click", () => warn(undefined));
place(optionsBox, part("#show-options", HTMLButtonElement));
place(part("#downloads", HTMLElement), part("#show-downloads", HTMLButtonElement));
optionsBox.addEventListener("beforetoggle", () => {
  options.show(parsed);
  void options.learn(parsed);
});
takeFiles(
  part("#drop", HTMLElement),
  part("#open", HTMLButtonElement),
  part("#file", HTMLInputElement),
  (contents) => void attempt(async () => put(await open(contents))),
);
share(part("main", HTMLElement), part("#split", HTMLElement));
switchTheme(part("#theme", HTMLButtonElement), (isDark) => {
  viewer.setAttribute("theme", isDark ? "dark" : "light");
  editor.isDark = isDark;
});
heedKey((key) => {
  if (key !== viewer.key) viewer.key = key;
});
askWhereWanted();
window.addEventListener("hashchange", () => void begin());
void begin();
enrichAfterwards();
