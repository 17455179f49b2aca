import { OTHERS, type Others } from "./emphasis.ts";
import { LABELS, type Labels } from "./labels.ts";
import { SHADOWS, type Shadows } from "./lighting.ts";
import { MOTIONS, type Motion } from "./motion.ts";
import type { Source } from "./showing.ts";
import { STEREO, type Stereo } from "./stereo.ts";

/** Attributes that say what is shown; all others say how. */
export const SOURCES = ["src", "program", "stored", "service", "conflicts"] as const;

export const ATTRIBUTES = [
  ...SOURCES,
  "motion",
  "stereo",
  "others",
  "labels",
  "shadows",
  "theme",
  "toolbar",
] as const;

/** How the picture is shown, by the element's attributes and by what whoever looks prefers. */
export interface Options {
  motion: Motion;
  stereo: Stereo;
  others: Others;
  labels: Labels;
  shadows: Shadows;
  isDark: boolean;
  isStill: boolean;
  hasToolbar: boolean;
}

export const STILL = "(prefers-reduced-motion: reduce)";
export const DARK = "(prefers-color-scheme: dark)";

export function optionsOf(element: Element): Options {
  const theme = element.getAttribute("theme");
  return {
    motion: oneOf(MOTIONS, element.getAttribute("motion"), "none"),
    stereo: oneOf(STEREO, element.getAttribute("stereo"), "none"),
    others: oneOf(OTHERS, element.getAttribute("others"), "dim"),
    labels: oneOf(LABELS, element.getAttribute("labels"), "auto"),
    shadows: oneOf(SHADOWS, element.getAttribute("shadows"), "auto"),
    isDark: theme === "dark" || (theme !== "light" && matchMedia(DARK).matches),
    isStill: matchMedia(STILL).matches,
    hasToolbar: element.hasAttribute("toolbar"),
  };
}

/** What a viewer is to show, by its attributes. */
export function sourceOf(element: Element): Source | undefined {
  const [stored, document, src] = ["stored", "program", "src"].map((name) => element.getAttribute(name));
  return stored ? { stored } : document ? { document } : src ? { src } : undefined;
}

function oneOf<Value extends string>(
  values: readonly Value[],
  value: string | null,
  otherwise: Value,
): Value {
  return values.find((each) => each === value) ?? otherwise;
}
