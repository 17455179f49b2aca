import type { Commands } from "./keyboard.ts";
import type { Options } from "./options.ts";
import { STEREO, type Stereo } from "./stereo.ts";

/** What the buttons do, besides what keys do too. */
export interface ToolbarCommands extends Commands {
  stereo(kind: Stereo): void;
  save(): void;
  headset(): void;
}

const ICONS = {
  fit: "M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4M7 10a3 3 0 1 0 6 0a3 3 0 1 0-6 0",
  motion: "M3 10a7 3 0 0 1 14 0a7 3 0 0 1-9 2.9M10 10.5l-2.2 2.3 2.6 2",
  others: "M2 10s3-5 8-5 8 5 8 5-3 5-8 5-8-5-8-5zM4 17L16 3",
  headset: "M3 6h14v8h-4l-1.500-2.500h-3L7 14H3z",
  save: "M10 3v9M6.5 9L10 12.5 13.500 9M3.500 16.500h13",
};

const VIEWS = { given: "As given", top: "From above", front: "From the front", side: "From the side" };
const EYES: Record<Stereo, string> = {
  none: "One picture",
  anaglyph: "Red and cyan",
  parallel: "Side by side",
  crossed: "Crossed eyes",
};

/** The buttons over the picture. */
export class Toolbar {
  readonly #others: HTMLButtonElement;
  readonly #motion: HTMLButtonElement;
  readonly #eyes: HTMLSelectElement;

  constructor(bar: HTMLElement, commands: ToolbarCommands) {
    const view = choice("View", VIEWS, (name) => {
      if (name) commands.look(name);
      view.value = "";
    });
    view.className = "narrow";
    view.prepend(new Option("View", "", true, true));
    view.value = "";
    this.#eyes = choice("Stereo", Object.fromEntries(STEREO.map((kind) => [kind, EYES[kind]])), (kind) =>
      commands.stereo(kind as Stereo),
    );
    this.#eyes.className = "wide";
    this.#others = button("Hide what is not selected (H)", ICONS.others, () => commands.toggleOthers());
    this.#motion = button("Sway (M)", ICONS.motion, () => commands.toggleMotion());
    bar.append(
      button("Show all (F)", ICONS.fit, () => commands.fit()),
      view,
      this.#others,
      this.#motion,
      this.#eyes,
      button("Save the picture", ICONS.save, () => commands.save()),
    );
    void hasHeadset().then((found) => {
      if (found) bar.append(button("Show in the headset", ICONS.headset, () => commands.headset()));
    });
  }

  /** Show what is on. */
  show({ others, motion, stereo }: Options): void {
    this.#others.setAttribute("aria-pressed", String(others === "hide"));
    this.#motion.setAttribute("aria-pressed", String(motion !== "none"));
    this.#eyes.value = stereo;
  }
}

async function hasHeadset(): Promise<boolean> {
  try {
    return (await navigator.xr?.isSessionSupported("immersive-vr")) ?? false;
  } catch {
    return false;
  }
}

function button(title: string, path: string, act: () => void): HTMLButtonElement {
  const made = document.createElement("button");
  made.type = "button";
  made.title = title;
  made.setAttribute("aria-label", title);
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 20 20");
  svg.setAttribute("aria-hidden", "true");
  const line = document.createElementNS("http://www.w3.org/2000/svg", "path");
  line.setAttribute("d", path);
  svg.append(line);
  made.append(svg);
  made.addEventListener("click", act);
  return made;
}

function choice(name: string, options: Record<string, string>, act: (value: string) => void): HTMLSelectElement {
  const made = document.createElement("select");
  made.setAttribute("aria-label", name);
  made.title = name;
  for (const [value, text] of Object.entries(options)) made.append(new Option(text, value));
  made.addEventListener("change", () => act(made.value));
  return made;
}
