import { Attention } from "./attention.ts";
import { ConflictMarks } from "./clearance.ts";
import { commandsOf } from "./commands.ts";
import { Emphasis } from "./emphasis.ts";
import type { Status, TubeEvents } from "./events.ts";
import { Framing } from "./framing.ts";
import { listenToKeys } from "./keyboard.ts";
import { Overlay } from "./labels.ts";
import type { Loaded } from "./loading.ts";
import { Mobile } from "./motion.ts";
import { Narration } from "./narration.ts";
import { ATTRIBUTES, optionsOf, sourceOf, SOURCES } from "./options.ts";
import { build, coveredBy, surroundings, type Parts } from "./page.ts";
import { Picker } from "./picking.ts";
import { watchPointer } from "./pointer.ts";
import { Scene } from "./scene.ts";
import { Showing, type Source } from "./showing.ts";
import { Stage } from "./stage.ts";
import { NO_WEBGL, StatusNote } from "./status.ts";
import { keyOf, type Thing, type ThingKey, type ThingName } from "./things.ts";
import { Toolbar } from "./toolbar.ts";

export type { Status, TubeEvents } from "./events.ts";

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
  readonly #note = new StatusNote(this, this.#parts, (status, detail) => this.#say("tube-status", { status, detail }));
  readonly #overlay = new Overlay(this.#scene, this.#parts.labels);
  readonly #commands = commandsOf(
    this,
    () => this.#attention.choose(undefined, false),
    () => this.#scene.name,
  );
  readonly #toolbar = new Toolbar(this.#parts.toolbar, this.#commands);
  readonly #narration = new Narration(this.#scene, this.#parts.list, this.#parts.live, {
    highlight: (key) => this.#attention.hover(key),
    choose: (key, isMore) => this.#attention.choose(key, isMore),
  });
  readonly #attention = new Attention(this.#scene, this.#emphasis, this.#narration, {
    changed: () => this.#emphasize(),
    hovered: (detail) => this.#say("tube-hover", detail),
    selected: (detail) => this.#say("tube-select", detail),
  });
  #stage: Stage | undefined;
  #mobile: Mobile | undefined;
  #framing: Framing | undefined;
  #isPlanned = false;
  #isNew = true;
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
    return this.#attention.selection;
  }

  set selection(names: readonly ThingName[]) {
    this.#attention.select(names.map(keyOf), false);
  }

  /** All that is shown: items and hyperedges. */
  get things(): Thing[] {
    return [...this.#scene.things.values()];
  }

  get status(): Status {
    return this.#note.status;
  }

  connectedCallback(): void {
    this.#left = new AbortController();
    try {
      this.#stage = new Stage(this.#parts.canvas);
    } catch {
      this.#note.tell("refused", NO_WEBGL);
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
    this.#framing?.fit();
  }

  /**
   * Look from `given` (as the document says), `top`, `front`, `side`, `back`, `isometric`, or from a
   * direction (z up).
   */
  look(view: string | readonly [number, number, number]): void {
    this.#framing?.look(view);
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
    const framing = (this.#framing = new Framing(stage, this.#scene, this.#emphasis, () => coveredBy(this.#parts)));
    focused.addEventListener("keydown", () => framing.leave(), { signal });
    listenToKeys(focused, stage, this.#commands, signal);
    watchPointer(canvas, signal, {
      hover: (place) => this.#attention.hover(place && this.#at(...place)),
      choose: (x, y, isMore) => this.#attention.choose(this.#at(x, y), isMore),
      fit: () => this.fit(),
    });
    surroundings(this, signal, () => framing.resize(), () => this.#dress());
  }

  #screen(): ConstructorParameters<typeof Showing>[0] {
    return {
      detail: () => this.#stage?.detail ?? { width: 256, height: 256 },
      whole: (loaded) => this.#showWhole(loaded),
      part: (loaded) => {
        if (!this.#scene.apply(loaded.gltf)) return;
        if (loaded.gltf.cameras.length > 0) this.#framing?.learn(loaded.gltf);
        this.#taken(loaded, true);
      },
      status: (status, detail) => this.#note.tell(status, detail),
      problem: (problem) => this.#say("tube-problem", { problem }),
      clearance: (clearance) => {
        // A frame may take long, and most edits leave the conflicts that there are.
        if (this.#marks.show(clearance.conflicts, this.#scene.box)) this.#stage?.invalidate();
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
    if (!this.#showing.isJudged) this.#marks.show([], this.#scene.box);
    return sourceOf(this);
  }

  #showWhole(loaded: Loaded): void {
    this.#emphasis.clear();
    this.#scene.replace(loaded.gltf);
    this.#framing?.learn(loaded.gltf);
    this.#taken(loaded, false);
    if (this.#isNew) this.#framing?.begin();
    this.#isNew = false;
  }

  #taken(loaded: Loaded, isPart: boolean): void {
    const stage = this.#stage;
    if (stage === undefined) return;
    const { box, name } = this.#scene;
    stage.box = box;
    this.#attention.revise();
    this.#light(stage);
    this.#emphasize();
    this.#narration.refresh();
    this.#parts.stage.setAttribute("aria-label", name || "Tubeloom");
    const { bytes, revision, asked } = loaded;
    const milliseconds = performance.now() - asked;
    this.#say("tube-load", { ...this.#scene.size, bytes, isPart, revision, milliseconds });
  }

  #light(stage: Stage): void {
    const { root, box, size } = this.#scene;
    stage.lighting.light(root, box, size.triangles, optionsOf(this).shadows);
  }

  #at(x: number, y: number): ThingKey | undefined {
    const { clientWidth, clientHeight } = this.#parts.canvas;
    return this.#stage && this.#picker.at(x, y, clientWidth, clientHeight, this.#stage.eye);
  }

  #emphasize(): void {
    this.#emphasis.apply();
    this.#parts.canvas.classList.toggle("on-thing", this.#emphasis.hovered !== undefined);
    if (this.#emphasis.others === "hide") this.#stage?.lighting.refresh();
    this.#stage?.invalidate();
  }

  #afterFrame(stage: Stage, milliseconds: number): void {
    const { clientWidth, clientHeight } = this.#parts.canvas;
    const { hovered, selected, isPlain } = this.#emphasis;
    const wanted = hovered === undefined ? selected : new Set([...selected, hovered]);
    this.#overlay.update(stage.eye, clientWidth, clientHeight, wanted, isPlain);
    this.#say("tube-frame", { milliseconds });
  }

  #say<Name extends keyof TubeEvents>(name: Name, detail: TubeEvents[Name]): void {
    this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true, composed: true }));
  }
}
