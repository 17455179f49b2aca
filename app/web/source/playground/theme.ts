const KEPT = "tubeloom.theme";

/** A button for light and dark; until it is pressed, the page heeds what the system prefers. */
export function switchTheme(button: HTMLButtonElement, heard: (isDark: boolean) => void): void {
  const preference = matchMedia("(prefers-color-scheme: dark)");
  const show = () => {
    const kept = localStorage.getItem(KEPT);
    const isDark = kept ? kept === "dark" : preference.matches;
    document.documentElement.dataset["theme"] = isDark ? "dark" : "light";
    button.setAttribute("aria-pressed", String(isDark));
    heard(isDark);
  };
  button.addEventListener("click", () => {
    const isDark = button.getAttribute("aria-pressed") === "true";
    localStorage.setItem(KEPT, isDark ? "light" : "dark");
    show();
  });
  preference.addEventListener("change", show);
  show();
}
