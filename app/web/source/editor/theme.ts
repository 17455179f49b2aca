import { useEffect, useState } from "react";

export type Theme = "system" | "light" | "dark";

const NAME = "tubeloom-theme";
const THEMES: readonly Theme[] = ["system", "light", "dark"];

/** How the page shall look: as the system does, or as was chosen here before. */
export function useTheme(): { theme: Theme; shown: "light" | "dark"; next: () => void } {
  const [theme, setTheme] = useState<Theme>(() => THEMES.find((each) => each === localStorage.getItem(NAME)) ?? "system");
  const [isDark, setIsDark] = useState(() => matchMedia("(prefers-color-scheme: dark)").matches);
  useEffect(() => {
    const preference = matchMedia("(prefers-color-scheme: dark)");
    const heed = () => setIsDark(preference.matches);
    preference.addEventListener("change", heed);
    return () => preference.removeEventListener("change", heed);
  }, []);
  const shown = theme === "system" ? (isDark ? "dark" : "light") : theme;
  useEffect(() => {
    document.documentElement.dataset["theme"] = shown;
    localStorage.setItem(NAME, theme);
  }, [theme, shown]);
  const next = () => setTheme(THEMES[(THEMES.indexOf(theme) + 1) % THEMES.length] ?? "system");
  return { theme, shown, next };
}
