const KEPT = "tubeloom.split";
const STEP = 2;
const USUAL = 40;

/** Lets people share the room between two parts: with the pointer, or with arrow keys. */
export function share(frame: HTMLElement, bar: HTMLElement): void {
  const narrow = matchMedia("(max-width: 720px)");
  const [least, most] = [Number(bar.ariaValueMin), Number(bar.ariaValueMax)];
  const set = (value: number) => {
    const percent = Math.round(Math.min(Math.max(value, least), most));
    bar.ariaValueNow = String(percent);
    bar.ariaValueText = `${percent} %`;
    frame.style.setProperty("--share", `${percent}%`);
    localStorage.setItem(KEPT, String(percent));
  };
  const turn = () => (bar.ariaOrientation = narrow.matches ? "horizontal" : "vertical");
  narrow.addEventListener("change", turn);
  turn();
  const kept = Number(localStorage.getItem(KEPT));
  set(kept || USUAL);

  bar.addEventListener("keydown", ({ key }) => {
    const now = Number(bar.ariaValueNow);
    // On a phone the text is below: a bar that goes up leaves it more room.
    const more = narrow.matches ? "ArrowUp" : "ArrowRight";
    const less = narrow.matches ? "ArrowDown" : "ArrowLeft";
    if (key === more) set(now + STEP);
    else if (key === less) set(now - STEP);
    else if (key === "Home") set(least);
    else if (key === "End") set(most);
  });
  bar.addEventListener("pointerdown", (event) => {
    bar.setPointerCapture(event.pointerId);
    event.preventDefault();
    bar.focus();
  });
  bar.addEventListener("pointermove", ({ pointerId, clientX, clientY }) => {
    if (!bar.hasPointerCapture(pointerId)) return;
    const { left, bottom, width, height } = frame.getBoundingClientRect();
    set(100 * (narrow.matches ? (bottom - clientY) / height : (clientX - left) / width));
  });
  bar.addEventListener("dblclick", () => set(USUAL));
}
