/** Puts a popover below the button that opens it. */
export function place(popover: HTMLElement, button: HTMLElement): void {
  popover.addEventListener("beforetoggle", (event) => {
    const isOpening = (event as ToggleEvent).newState === "open";
    button.setAttribute("aria-expanded", String(isOpening));
    if (!isOpening) return;
    const { left, right, bottom } = button.getBoundingClientRect();
    const isOnLeft = left + right < innerWidth;
    const { style } = popover;
    style.top = `${bottom + 6}px`;
    style.maxHeight = `${innerHeight - bottom - 18}px`;
    style.left = isOnLeft ? `${Math.max(8, Math.min(left, innerWidth - 328))}px` : "auto";
    style.right = isOnLeft ? "auto" : `${Math.max(8, Math.min(innerWidth - right, innerWidth - 328))}px`;
  });
  button.setAttribute("aria-expanded", "false");
}
