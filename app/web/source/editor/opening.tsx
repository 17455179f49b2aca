import { useEffect, useRef, useState, type ReactElement } from "react";
import { authorization } from "../key.ts";

interface Listed {
  id: string;
  name?: string | null;
  item_count: number;
  hyperedge_count: number;
}

interface OpeningProps {
  onFile: (file: File) => void;
  onClose: () => void;
}

/** Lists the programs that the service keeps, and takes files. */
export function Opening({ onFile, onClose }: OpeningProps): ReactElement {
  const dialog = useRef<HTMLDialogElement>(null);
  const [programs, setPrograms] = useState<Listed[] | undefined>();
  const [trouble, setTrouble] = useState("");
  useEffect(() => {
    dialog.current?.showModal();
    void fetch("/v1/programs?limit=100", { headers: authorization() }).then(
      async (response) => {
        if (response.ok) setPrograms(((await response.json()) as { programs: Listed[] }).programs);
        else setTrouble(`The service does not list programs (${response.status}).`);
      },
      () => setTrouble("The service does not answer."),
    );
  }, []);
  return (
    <dialog ref={dialog} aria-labelledby="opening" onClose={onClose}>
      <header>
        <h2 id="opening">Open a program</h2>
        <button type="button" aria-label="Close" onClick={() => dialog.current?.close()}>
          ✕
        </button>
      </header>
      {trouble ? <p role="alert">{trouble}</p> : null}
      {programs?.length === 0 ? <p>No program is stored yet.</p> : null}
      <ul>
        {programs?.map(({ id, name, item_count, hyperedge_count }) => (
          <li key={id}>
            <a href={`?program=${encodeURIComponent(id)}`}>
              <b>{name || id}</b>
              <small>
                {id} · {item_count} items, {hyperedge_count} hyperedges
              </small>
            </a>
          </li>
        ))}
      </ul>
      <footer>
        <label className="button">
          From a file …
          <input
            type="file"
            accept=".json,application/json"
            onChange={(event) => {
              const [file] = event.currentTarget.files ?? [];
              dialog.current?.close();
              if (file) onFile(file);
            }}
          />
        </label>
      </footer>
    </dialog>
  );
}

/** Let the browser keep a text as a file. */
export function download(name: string, text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
