import { useEffect, useState } from "react";

const KEPT = "tubeloom.theme";

/** Light or dark, before there is anything that could switch it. */
export function wearTheme(): void {
  const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset["theme"] = localStorage.getItem(KEPT) ?? (isDark ? "dark" : "light");
}

/** Light or dark: as the system prefers, until it is switched on one of the pages. */
export function useTheme(): { theme: "light" | "dark"; switchTheme: () => void } {
  const [kept, setKept] = useState(() => localStorage.getItem(KEPT));
  const [isDark, setIsDark] = useState(() => matchMedia("(prefers-color-scheme: dark)").matches);
  useEffect(() => {
    const preference = matchMedia("(prefers-color-scheme: dark)");
    const heed = () => setIsDark(preference.matches);
    preference.addEventListener("change", heed);
    return () => preference.removeEventListener("change", heed);
  }, []);
  const theme = (kept ?? (isDark ? "dark" : "light")) === "dark" ? "dark" : "light";
  useEffect(() => {
    document.documentElement.dataset["theme"] = theme;
  }, [theme]);
  const switchTheme = () => {
    const next = theme === "dark" ? "light" : "dark";
    localStorage.setItem(KEPT, next);
    setKept(next);
  };
  return { theme, switchTheme };
}
