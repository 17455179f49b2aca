/** What a pointer on the picture means; places are in pixels from its top left corner. */
export interface PointerListener {
  hover(place: [number, number] | undefined): void;
  choose(x: number, y: number, isMore: boolean): void;
  fit(): void;
}

/** A pointer that moves farther than this turns the picture, and chooses nothing. */
const CLICK_PIXELS = 4;

/** Tells a click from a drag, and hover once for each frame, until `signal` is aborted. */
export function watchPointer(
  canvas: HTMLCanvasElement,
  signal: AbortSignal,
  listener: PointerListener,
): void {
  const options = { signal };
  let pressed: { x: number; y: number } | undefined;
  let waiting: PointerEvent | undefined;

  canvas.addEventListener(
    "pointermove",
    (event) => {
      if (event.buttons !== 0 || event.pointerType === "touch") return;
      if (waiting === undefined) {
        requestAnimationFrame(() => {
          if (waiting) listener.hover([waiting.offsetX, waiting.offsetY]);
          waiting = undefined;
        });
      }
      waiting = event;
    },
    options,
  );
  canvas.addEventListener(
    "pointerleave",
    () => {
      waiting = undefined;
      listener.hover(undefined);
    },
    options,
  );
  canvas.addEventListener(
    "pointerdown",
    (event) => {
      pressed = event.isPrimary ? { x: event.clientX, y: event.clientY } : undefined;
    },
    options,
  );
  canvas.addEventListener(
    "pointerup",
    (event) => {
      if (pressed === undefined || event.button !== 0) return;
      const moved = Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y);
      pressed = undefined;
      if (moved > CLICK_PIXELS) return;
      listener.choose(event.offsetX, event.offsetY, event.shiftKey || event.ctrlKey || event.metaKey);
    },
    options,
  );
  canvas.addEventListener("dblclick", () => listener.fit(), options);
}
