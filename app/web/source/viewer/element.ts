import { PerspectiveCamera, Vector3 } from "three";
import { directionFrom, directionOf } from "./camera.ts";
import { ConflictMarks } from "./clearance.ts";
import { Emphasis } from "./emphasis.ts";
import type { Status, TubeEvents } from "./events.ts";
import { listenToKeys } from "./keyboard.ts";
import { Overlay } from "./labels.ts";
import type { Detail, Loaded } from "./loading.ts";
import { Mobile } from "./motion.ts";
import { Narration } from "./narration.ts";
import { ATTRIBUTES, DARK, optionsOf, SOURCES, STILL } from "./options.ts";
import { build, type Parts } from "./page.ts";
import { Picker } from "./picking.ts";
import { watchPointer } from "./pointer.ts";
import { Scene } from "./scene.ts";
import { Showing, type Source } from "./showing.ts";
import { Stage } from "./stage.ts";
import { keyOf, type Thing, type ThingKey, type ThingName } from "./things.ts";
import { Toolbar, type ToolbarCommands } from "./toolbar.ts";

export type { Status, TubeEvents } from "./events.ts";

const VIEWS: Record<string, readonly [number, number, number]> = {
  top: [0, 0, 1],
  front: [0, -1, 0.12],
  side: [1, 0, 0.12],
  back: [0, 1, 0.12],
  isometric: [1, -1, 0.82],
};

const USUAL_DIRECTION = directionFrom([0.2, -1, 1]);
const NO_WEBGL = "This browser does not show 3D pictures: WebGL 2 is missing or switched off.";

/**
 * `<tube-viewer>`: shows a program's scene, and lets people look around in it.
 *
 * What it shows: `stored` (the id of a stored program, whose revisions it follows), `program` (a
 * document as text, or set the property) or `src` (the address of a GLB file).
 */
export class TubeViewer extends HTMLElement {
  static readonly observedAttributes = ATTRIBUTES;

  readonly #scene = new Scene();
  readonly #emphasis = new Emphasis(this.#scene);
  readonly #picker = new Picker(this.#scene);
  readonly #marks = new ConflictMarks();
  readonly #showing = new Showing(this.#screen(), new URL(import.meta.url).origin);
  readonly #parts: Parts = build(this.attachShadow({ mode: "open" }));
  readonly #overlay = new Overlay(this.#scene, this.#parts.labels);
  readonly #toolbar = new Toolbar(this.#parts.toolbar, this.#commands());
  readonly #narration = new Narration(this.#scene, this.#parts.list, this.#parts.live, {
    highlight: (key) => this.#hover(key),
    choose: (key, isMore) => this.#choose(key, isMore),
  });
  #stage: Stage | undefined;
  #mobile: Mobile | undefined;
  /** The direction in which the document has its camera. */
  #given = USUAL_DIRECTION;
  #status: Status = "empty";
  #isPlanned = false;
  #isNew = true;
  #isFitted = true;
  #left = new AbortController();

  /** An API key, where the service wants one. It is sent in a header, to the service alone. */
  get key(): string | undefined {
    return this.#showing.asker.key;
  }

  set key(key: string | undefined) {
    this.#showing.asker.key = key;
    this.refresh();
  }

  /** The document that is shown, as text; an object may be set. */
  get program(): string | null {
    return this.getAttribute("program");
  }

  set program(document: string | object | null) {
    if (document === null) this.removeAttribute("program");
    else this.setAttribute("program", typeof document === "string" ? document : JSON.stringify(document));
  }

  /**
   * What is selected. Setting it tells nobody, for whoever sets it knows; what is not shown is left
   * out.
   */
  get selection(): Thing[] {
    const found = [...this.#emphasis.selected].map((key) => this.#scene.things.get(key));
    return found.filter((thing) => thing !== undefined);
  }

  set selection(names: readonly ThingName[]) {
    const keys = names.map(keyOf).filter((key) => this.#scene.things.has(key));
    this.#select(new Set(keys), false);
  }

  /** All that is shown: items and hyperedges. */
  get things(): Thing[] {
    return [...this.#scene.things.values()];
  }

  get status(): Status {
    return this.#status;
  }

  connectedCallback(): void {
    this.#left = new AbortController();
    try {
      this.#stage = new Stage(this.#parts.canvas);
    } catch {
      this.#tell("refused", NO_WEBGL);
      return;
    }
    this.#enter(this.#stage);
    this.#dress();
    this.#narration.refresh();
    this.refresh();
  }

  disconnectedCallback(): void {
    this.#left.abort();
    this.#showing.end();
    this.#emphasis.clear();
    this.#scene.clear();
    this.#marks.dispose();
    this.#stage?.dispose();
    this.#stage = undefined;
    this.#isNew = true;
  }

  attributeChangedCallback(name: string, before: string | null, after: string | null): void {
    if (before === after || this.#stage === undefined) return;
    if (!SOURCES.some((source) => source === name)) {
      this.#dress();
      return;
    }
    if (name === "src" || name === "stored" || name === "service") this.#isNew = true;
    this.refresh();
  }

  /** Ask for the scene anew. What is asked for in one go is asked for once. */
  refresh(): void {
    if (this.#isPlanned || this.#stage === undefined) return;
    this.#isPlanned = true;
    queueMicrotask(() => {
      this.#isPlanned = false;
      if (this.#stage) void this.#showing.show(this.#source());
    });
  }

  /** Step back or nearer, until all is just seen. */
  fit(): void {
    if (this.#stage) this.#fit(this.#stage, "gently");
  }

  /**
   * Look from `given` (as the document says), `top`, `front`, `side`, `back`, `isometric`, or from a
   * direction (z up).
   */
  look(view: string | readonly [number, number, number]): void {
    const named = typeof view === "string" ? VIEWS[view] : view;
    const direction = named ? directionFrom(named) : this.#given;
    this.#stage?.look(this.#stage.around(this.#shownCorners(), direction));
    this.#isFitted = true;
  }

  /** Once a frame shows all that was changed until now. */
  async drawn(): Promise<void> {
    await this.#stage?.drawn();
  }

  /** What is seen, as PNG, `scale` times as large as on the page. */
  exportPicture(scale = 2): Promise<Blob> {
    if (this.#stage === undefined) throw new Error("The viewer is not on a page.");
    return this.#stage.picture(scale, getComputedStyle(this).backgroundColor);
  }

  /** Show the picture in a headset. Throws where there is none. */
  async enterHeadset(): Promise<void> {
    if (this.#stage === undefined || navigator.xr === undefined) throw new Error("There is no headset.");
    const { enterHeadset } = await import("./headset.ts");
    await enterHeadset(this.#stage, this.#scene);
  }

  #enter(stage: Stage): void {
    const { canvas, stage: focused } = this.#parts;
    const { signal } = this.#left;
    this.#scene.isPlain = stage.isSoftware;
    stage.world.add(this.#scene.root, this.#marks.group);
    stage.onframe = (milliseconds) => this.#afterFrame(stage, milliseconds);
    this.#mobile = new Mobile(stage);
    listenToKeys(focused, stage, this.#commands(), signal);
    watchPointer(canvas, signal, {
      hover: (place) => this.#hover(place && this.#at(...place)),
      choose: (x, y, isMore) => this.#choose(this.#at(x, y), isMore),
      fit: () => this.fit(),
    });
    // As long as nobody has chosen where to look from, all is seen, however the size changes.
    stage.controls.addEventListener("start", () => (this.#isFitted = false));
    focused.addEventListener("keydown", () => (this.#isFitted = false), { signal });
    const sizes = new ResizeObserver(() => {
      stage.resize();
      if (this.#isFitted) this.#fit(stage, "at once");
    });
    sizes.observe(this);
    signal.addEventListener("abort", () => sizes.disconnect());
    for (const preference of [STILL, DARK]) {
      matchMedia(preference).addEventListener("change", () => this.#dress(), { signal });
    }
  }

  #commands(): ToolbarCommands {
    return {
      fit: () => this.fit(),
      look: (view) => this.look(view),
      clear: () => this.#choose(undefined, false),
      toggleOthers: () => this.#toggle("others", "hide"),
      toggleMotion: () => this.#toggle("motion", "sway"),
      stereo: (kind) => this.setAttribute("stereo", kind),
      save: () => void this.#save(),
    };
  }

  #screen(): ConstructorParameters<typeof Showing>[0] {
    return {
      detail: () => this.#detail(),
      whole: (loaded) => this.#showWhole(loaded),
      part: (loaded) => {
        if (this.#scene.apply(loaded.gltf)) this.#taken(loaded, true);
      },
      status: (status, detail) => this.#tell(status, detail),
      problem: (problem) => this.#say("tube-problem", { problem }),
      clearance: (clearance) => {
        this.#marks.show(clearance.conflicts, this.#scene.box.getSize(new Vector3()).length() / 60);
        this.#stage?.invalidate();
        this.#say("tube-clearance", { clearance });
      },
    };
  }

  /** Make the element as its attributes say. */
  #dress(): void {
    const stage = this.#stage;
    if (stage === undefined || this.#mobile === undefined) return;
    const options = optionsOf(this);
    this.dataset["theme"] = options.isDark ? "dark" : "light";
    stage.reducedMotion = options.isStill;
    stage.stereo = options.stereo;
    this.#mobile.motion = options.motion;
    // With two pictures there would be two places for each.
    this.#parts.labels.hidden = options.stereo !== "none";
    this.#overlay.labels = options.labels;
    this.#emphasis.others = options.others;
    this.#parts.toolbar.hidden = !options.hasToolbar;
    this.#toolbar.show(options);
    this.#light(stage);
    this.#emphasize();
  }

  #source(): Source | undefined {
    const service = this.getAttribute("service");
    if (service !== null) this.#showing.asker.base = new URL(service, location.href).href.replace(/\/+$/, "");
    this.#showing.isJudged = this.hasAttribute("conflicts");
    if (!this.#showing.isJudged) this.#marks.show([], 0);
    const [stored, document, src] = ["stored", "program", "src"].map((name) => this.getAttribute(name));
    return stored ? { stored } : document ? { document } : src ? { src } : undefined;
  }

  #showWhole(loaded: Loaded): void {
    const stage = this.#stage;
    if (stage === undefined) return;
    this.#emphasis.clear();
    this.#scene.replace(loaded.gltf);
    const [camera] = loaded.gltf.cameras;
    this.#given = camera instanceof PerspectiveCamera ? directionOf(camera) : USUAL_DIRECTION;
    this.#taken(loaded, false);
    if (!this.#isNew) return;
    stage.look(stage.around(this.#scene.cornersOf(), this.#given), "at once");
    this.#isFitted = true;
    this.#isNew = false;
  }

  #taken(loaded: Loaded, isPart: boolean): void {
    const stage = this.#stage;
    if (stage === undefined) return;
    const { things, box, size, name } = this.#scene;
    stage.box = box;
    const kept = [...this.#emphasis.selected].filter((key) => things.has(key));
    if (kept.length !== this.#emphasis.selected.size) this.#select(new Set(kept), true);
    if (this.#emphasis.hovered && !things.has(this.#emphasis.hovered)) this.#hover(undefined);
    this.#light(stage);
    this.#emphasize();
    this.#narration.refresh();
    this.#parts.stage.setAttribute("aria-label", name || "Tubeloom");
    const hyperedges = this.things.filter(({ shows }) => shows === "hyperedge").length;
    this.#say("tube-load", {
      items: things.size - hyperedges,
      hyperedges,
      ...size,
      bytes: loaded.bytes,
      isPart,
      revision: loaded.revision,
      milliseconds: performance.now() - loaded.asked,
    });
  }

  #light(stage: Stage): void {
    const { root, box, size } = this.#scene;
    stage.lighting.light(root, box, size.triangles, optionsOf(this).shadows);
  }

  #at(x: number, y: number): ThingKey | undefined {
    const { clientWidth, clientHeight } = this.#parts.canvas;
    return this.#stage && this.#picker.at(x, y, clientWidth, clientHeight, this.#stage.camera);
  }

  #hover(key: ThingKey | undefined): void {
    if (key === this.#emphasis.hovered) return;
    this.#emphasis.hovered = key;
    this.#parts.canvas.classList.toggle("on-thing", key !== undefined);
    this.#emphasize();
    this.#say("tube-hover", { thing: key && this.#scene.things.get(key) });
  }

  #choose(key: ThingKey | undefined, isMore: boolean): void {
    const chosen = new Set(isMore ? this.#emphasis.selected : []);
    if (key !== undefined && !(isMore && chosen.delete(key))) chosen.add(key);
    this.#select(chosen, true);
    const sentence = key === undefined ? "Nothing is selected." : `Selected: ${this.#narration.sentenceOf(key)}`;
    this.#narration.say(sentence);
  }

  #select(keys: ReadonlySet<ThingKey>, isTold: boolean): void {
    const before = this.#emphasis.selected;
    if (keys.size === before.size && [...keys].every((key) => before.has(key))) return;
    this.#emphasis.selected = keys;
    this.#narration.selected = keys;
    this.#emphasize();
    if (isTold) this.#say("tube-select", { things: this.selection });
  }

  #emphasize(): void {
    this.#emphasis.apply();
    if (this.#emphasis.others === "hide") this.#stage?.lighting.refresh();
    this.#stage?.invalidate();
  }

  #afterFrame(stage: Stage, milliseconds: number): void {
    const { clientWidth, clientHeight } = this.#parts.canvas;
    const { hovered, selected, isPlain } = this.#emphasis;
    const wanted = hovered === undefined ? selected : new Set([...selected, hovered]);
    this.#overlay.update(stage.camera, clientWidth, clientHeight, wanted, isPlain);
    this.#marks.face(stage.camera);
    this.#say("tube-frame", { milliseconds });
  }

  #fit(stage: Stage, when: "gently" | "at once"): void {
    const { position, target } = stage.pose;
    stage.look(stage.around(this.#shownCorners(), position.sub(target)), when);
    this.#isFitted = true;
  }

  /** Of what is not hidden. */
  #shownCorners(): Vector3[] {
    const { selected, others } = this.#emphasis;
    const isPart = selected.size > 0 && others === "hide";
    return isPart ? this.#scene.cornersOf(selected) : this.#scene.cornersOf();
  }

  #detail(): Detail {
    const { clientWidth, clientHeight } = this.#parts.canvas;
    const ratio = this.#stage?.isSoftware ? 0.5 : Math.min(devicePixelRatio, 2);
    const clamp = (size: number) => Math.min(Math.max(Math.round((size * ratio) / 256) * 256, 256), 4096);
    return { width: clamp(clientWidth), height: clamp(clientHeight) };
  }

  async #save(): Promise<void> {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(await this.exportPicture());
    link.download = `${this.#scene.name || "tubeloom"}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }

  #toggle(attribute: string, value: string): void {
    if (this.getAttribute(attribute) === value) this.removeAttribute(attribute);
    else this.setAttribute(attribute, value);
  }

  #tell(status: Status, detail: string): void {
    const { progress, status: note } = this.#parts;
    progress.hidden = status !== "loading";
    note.hidden = detail === "";
    if (note.textContent !== detail) note.textContent = detail;
    if (status === this.#status && status !== "refused") return;
    this.#status = status;
    this.dataset["status"] = status;
    this.#say("tube-status", { status, detail });
  }

  #say<Name extends keyof TubeEvents>(name: Name, detail: TubeEvents[Name]): void {
    this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true, composed: true }));
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "tube-viewer": TubeViewer;
  }
}

customElements.define("tube-viewer", TubeViewer);
