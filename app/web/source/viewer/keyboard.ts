import { approach, shift, turn } from "./motion.ts";
import type { Stage } from "./stage.ts";

/** What keys do to the picture, besides turning it. */
export interface Commands {
  fit(): void;
  look(view: string): void;
  clear(): void;
  toggleOthers(): void;
  toggleMotion(): void;
}

export const HELP =
  "Arrow keys turn the picture, with Shift they move it; plus and minus go nearer and away; " +
  "F shows all, 1 to 4 show it as given, from above, from the front and from the side; " +
  "H hides what is not selected, M lets it sway, Escape selects nothing. Tab goes to the list.";

const DEGREES = 6;
const SHARE = 0.06;
const NEARER = 0.85;
const VIEWS: Record<string, string> = { "1": "given", "2": "top", "3": "front", "4": "side" };

/** Lets the keyboard do what the pointer does, until `signal` is aborted. */
export function listenToKeys(
  element: HTMLElement,
  stage: Stage,
  commands: Commands,
  signal: AbortSignal,
): void {
  const listen = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const act = actionOf(event, stage, commands);
    if (act === undefined) return;
    event.preventDefault();
    act();
  };
  element.addEventListener("keydown", listen, { signal });
}

function actionOf(event: KeyboardEvent, stage: Stage, commands: Commands): (() => void) | undefined {
  const { key, shiftKey } = event;
  const arrows: Record<string, [number, number]> = {
    ArrowLeft: [-1, 0],
    ArrowRight: [1, 0],
    ArrowUp: [0, 1],
    ArrowDown: [0, -1],
  };
  const arrow = arrows[key];
  if (arrow) {
    const [right, up] = arrow;
    return shiftKey
      ? () => shift(stage, -right * SHARE, -up * SHARE)
      : () => turn(stage, -right * DEGREES, up * DEGREES);
  }
  const view = VIEWS[key];
  if (view !== undefined) return () => commands.look(view);
  switch (key) {
    case "+":
    case "=":
      return () => approach(stage, NEARER);
    case "-":
    case "_":
      return () => approach(stage, 1 / NEARER);
    case "f":
    case "Home":
      return () => commands.fit();
    case "h":
      return () => commands.toggleOthers();
    case "m":
      return () => commands.toggleMotion();
    case "Escape":
      return () => commands.clear();
    default:
      return undefined;
  }
}
