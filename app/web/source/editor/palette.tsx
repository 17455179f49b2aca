import type { ReactElement } from "react";
import { KIND_TYPE } from "./canvas.tsx";
import { KINDS, type Kind } from "./kinds.ts";

/** The kinds of nodes there are: press one, or drag it to its place. */
export function Palette({ onAdd }: { onAdd: (kind: Kind) => void }): ReactElement {
  return (
    <nav className="palette" aria-label="Palette">
      {KINDS.map((kind) => (
        <button
          key={kind.name}
          type="button"
          draggable
          aria-label={`Add ${kind.title.toLowerCase()}`}
          title={`Add a ${kind.title.toLowerCase()}: press, or drag to its place`}
          onClick={() => onAdd(kind)}
          onDragStart={(event) => event.dataTransfer.setData(KIND_TYPE, kind.name)}
        >
          <span className="swatch" style={{ background: kind.color }} />
          <span>{kind.title}</span>
        </button>
      ))}
    </nav>
  );
}
