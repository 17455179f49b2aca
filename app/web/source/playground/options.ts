import { heedKey, keepKey } from "../key.ts";
import { make } from "./page.ts";
import { valueAt, type Parsed } from "./places.ts";
import { palettes } from "./service.ts";

type Path = readonly ["layout" | "style" | "view", string];

/** A choice among values; the first one is what leaving it out means. */
interface Choice {
  path: Path;
  name: string;
  values: [value: unknown, title: string][];
}

const CURVES: Choice = {
  path: ["layout", "curves"],
  name: "Curves",
  values: [[null, "As fidelity says"], ["steiner", "Steiner trees"], ["prose", "The paper's words"], ["symbolic", "The paper's symbols"]],
};
const PALETTE: Choice = { path: ["style", "palette"], name: "Palette", values: [["glasbey", "Glasbey"]] };

const SECTIONS: Record<string, Choice[]> = {
  Layout: [
    CURVES,
    { path: ["layout", "fidelity"], name: "Fidelity", values: [["best", "Best"], ["paper", "As in the paper"]] },
    { path: ["layout", "dimensions"], name: "Dimensions", values: [[3, "Three"], [2, "Two, from above"]] },
    { path: ["layout", "tube"], name: "Tubes", values: [["swept", "Swept circle"], ["patches", "Bézier patches"]] },
  ],
  Style: [
    PALETTE,
    {
      path: ["style", "background"],
      name: "Background",
      values: [["#ffffff", "White"], ["#eef2f7", "Mist"], ["#d3d8e0", "Grey"], ["#12171f", "Night"], ["transparent", "Transparent"]],
    },
    { path: ["style", "labels"], name: "Labels", values: [[true, "Shown"], [false, "Hidden"]] },
    { path: ["style", "ground"], name: "Ground", values: [[true, "Shown"], [false, "Hidden"]] },
    { path: ["style", "hidden_lines"], name: "Hidden lines", values: [["removed", "Removed"], ["dashed", "Dashed"]] },
  ],
  View: [
    {
      path: ["view", "from"],
      name: "Seen from",
      values: [
        [[0.2, -1, 1], "As usual"],
        [[0, 0, 1], "Above"],
        [[0, -1, 0.2], "The front"],
        [[1, 0, 0.2], "The right"],
        [[-1, 0, 0.2], "The left"],
        [[0, 1, 0.2], "The back"],
        [[1, -1, 0.82], "A corner"],
      ],
    },
    { path: ["view", "projection"], name: "Projection", values: [["perspective", "Perspective"], ["orthographic", "Parallel"]] },
    { path: ["view", "stereo"], name: "Two eyes", values: [[null, "No"], ["side-by-side", "Side by side"], ["anaglyph", "Red and cyan"]] },
  ],
};

const USUAL_CLEARANCE = 0.05;

/** The options that a program has, to be chosen rather than typed. */
export class Options {
  readonly #write: (path: Path, value: unknown) => void;
  readonly #selects: { choice: Choice; select: HTMLSelectElement }[] = [];
  readonly #clearance = make("input");

  /** `write` puts a value into the text; nothing for what leaving it out means. */
  constructor(host: HTMLElement, write: (path: Path, value: unknown) => void) {
    this.#write = write;
    for (const [name, choices] of Object.entries(SECTIONS)) {
      const fields = choices.map((choice) => this.#field(choice));
      if (name === "Layout") fields.push(this.#clearanceField());
      host.append(make("fieldset", {}, make("legend", { text: name }), ...fields));
    }
    host.append(
      make("fieldset", {}, make("legend", { text: "Service" }), keyField()),
      make("p", { className: "hint", text: "Each choice is written into the program. Style and view are those of draft and final pictures and of downloads." }),
    );
  }

  /** Ask the service for what it alone knows. */
  async learn(parsed: Parsed): Promise<void> {
    if (PALETTE.values.length > 1) return;
    const known = await palettes().catch(() => []);
    if (known.length > 0) PALETTE.values = known.map(({ name, title }) => [name, title]);
    this.show(parsed);
  }

  /** Show what the text says. */
  show(parsed: Parsed): void {
    for (const { choice, select } of this.#selects) {
      const written = valueAt(parsed, choice.path) ?? choice.values[0]?.[0];
      const isKnown = choice.values.some(([value]) => isSame(value, written));
      const values: Choice["values"] = isKnown ? choice.values : [...choice.values, [written, `As written: ${nameOf(written)}`]];
      select.replaceChildren(...values.map(([value, title]) => new Option(title, JSON.stringify(value))));
      select.value = JSON.stringify(written);
    }
    const clearance = valueAt(parsed, ["layout", "clearance"]);
    if (document.activeElement === this.#clearance) return;
    this.#clearance.value = clearance === null ? "" : String(clearance ?? USUAL_CLEARANCE);
  }

  #field(choice: Choice): HTMLElement {
    const select = make("select");
    this.#selects.push({ choice, select });
    select.addEventListener("change", () => {
      const value = JSON.parse(select.value) as unknown;
      this.#write(choice.path, isSame(value, choice.values[0]?.[0]) ? undefined : value);
    });
    return make("label", {}, make("span", { text: choice.name }), select);
  }

  #clearanceField(): HTMLElement {
    const input = this.#clearance;
    Object.assign(input, { type: "number", min: "0", max: "10", step: "0.01", placeholder: "not looked at" });
    input.addEventListener("change", () => {
      if (input.value !== "" && !input.checkValidity()) return;
      const value = input.value === "" ? null : Number(input.value);
      this.#write(["layout", "clearance"], value === USUAL_CLEARANCE ? undefined : value);
    });
    return make("label", {}, make("span", { text: "Clearance" }), input);
  }
}

/** Some services want a key. It stays in this tab. */
function keyField(): HTMLElement {
  const input = make("input");
  Object.assign(input, { type: "password", autocomplete: "off", placeholder: "where one is wanted" });
  heedKey((key) => (input.value = key ?? ""));
  input.addEventListener("change", () => keepKey(input.value));
  const form = make("form", {}, make("label", {}, make("span", { text: "API key" }), input));
  form.addEventListener("submit", (event) => event.preventDefault());
  return form;
}

function isSame(one: unknown, other: unknown): boolean {
  return JSON.stringify(one) === JSON.stringify(other);
}

function nameOf(value: unknown): string {
  return Array.isArray(value) ? value.join(", ") : String(value);
}
