/** How the element looks. A page changes it by the `--tube-…` properties and by `::part()`. */
export const STYLES = `
:host {
  --ink: var(--tube-ink, #1b2430);
  --paper: var(--tube-paper, #ffffff);
  --accent: var(--tube-accent, #1d5fd1);
  --edge: color-mix(in srgb, var(--ink) 16%, transparent);
  display: block;
  position: relative;
  overflow: hidden;
  min-height: 8rem;
  background: var(--paper);
  color: var(--ink);
  color-scheme: light;
  font: 500 13px/1.4 system-ui, sans-serif;
  contain: layout paint;
}
:host([hidden]) { display: none; }
:host([data-theme="dark"]) {
  --ink: var(--tube-ink, #e8edf4);
  --paper: var(--tube-paper, #12171f);
  --accent: var(--tube-accent, #7fb2ff);
  color-scheme: dark;
}
#stage { position: absolute; inset: 0; outline: none; }
canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; cursor: grab; touch-action: none; }
canvas:active { cursor: grabbing; }
canvas.on-thing { cursor: pointer; }
#stage:focus-visible { box-shadow: inset 0 0 0 3px var(--accent); }
#labels { position: absolute; inset: 0; overflow: hidden; pointer-events: none; }
#labels[hidden] { display: none; }
#labels span {
  position: absolute;
  left: 0;
  top: 0;
  padding: 0 6px;
  border-radius: 9px;
  font: 600 12px/18px system-ui, sans-serif;
  white-space: nowrap;
  background: color-mix(in srgb, var(--paper) 86%, transparent);
  color: var(--ink);
  box-shadow: 0 0 0 1px var(--edge);
}
#labels span.wanted { background: var(--ink); color: var(--paper); box-shadow: 0 1px 4px rgb(0 0 0 / 0.25); }
#labels span[hidden] { display: none; }
#toolbar {
  position: absolute;
  right: 10px;
  top: 10px;
  display: flex;
  gap: 2px;
  padding: 3px;
  border-radius: 10px;
  background: color-mix(in srgb, var(--paper) 92%, transparent);
  box-shadow: 0 0 0 1px var(--edge), 0 2px 8px rgb(0 0 0 / 0.08);
}
#toolbar[hidden] { display: none; }
button, select {
  font: inherit;
  color: inherit;
  background: transparent;
  border: 0;
  border-radius: 7px;
  min-width: 32px;
  height: 32px;
  padding: 0 7px;
  cursor: pointer;
}
select { padding: 0 2px; }
select.narrow { width: 4.4rem; }
select option { color: var(--ink); background: var(--paper); }
button:hover, select:hover { background: color-mix(in srgb, var(--ink) 9%, transparent); }
button[aria-pressed="true"] { background: var(--accent); color: var(--paper); }
button:focus-visible, select:focus-visible, #list:focus-visible { outline: 2px solid var(--accent); outline-offset: 1px; }
button svg { display: block; width: 18px; height: 18px; fill: none; stroke: currentColor; stroke-width: 1.7; stroke-linecap: round; stroke-linejoin: round; }
#list {
  position: absolute;
  left: 50%;
  bottom: 10px;
  transform: translateX(-50%);
  max-width: calc(100% - 24px);
  padding: 6px 12px;
  border-radius: 10px;
  background: var(--paper);
  box-shadow: 0 0 0 1px var(--edge), 0 2px 10px rgb(0 0 0 / 0.15);
}
#list:not(:focus) { clip-path: inset(50%); width: 1px; height: 1px; padding: 0; overflow: hidden; white-space: nowrap; }
#list [aria-selected="true"] { font-weight: 700; }
#status {
  position: absolute;
  left: 10px;
  top: 10px;
  max-width: calc(100% - 20px);
  padding: 5px 11px;
  border-radius: 10px;
  background: var(--ink);
  color: var(--paper);
}
:host([toolbar]) #status { top: 58px; }
#status[hidden] { display: none; }
#progress { position: absolute; left: 0; right: 0; top: 0; height: 3px; overflow: hidden; }
#progress[hidden] { display: none; }
#progress::after { content: ""; position: absolute; inset: 0 60% 0 0; background: var(--accent); animation: along 1.1s infinite ease-in-out; }
@keyframes along { from { transform: translateX(-100%); } to { transform: translateX(260%); } }
@media (prefers-reduced-motion: reduce) { #progress::after { animation: none; inset: 0; opacity: 0.6; } }
.unseen { position: absolute; clip-path: inset(50%); width: 1px; height: 1px; overflow: hidden; white-space: nowrap; }
@media (max-width: 480px) { #toolbar .wide { display: none; } }
`;
