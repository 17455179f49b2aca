import type { ReactElement } from "react";

type Command = (() => void) | undefined;

/** What the buttons do; undefined where there is nothing to do. */
export interface Commands {
  undo: Command;
  redo: Command;
  join: Command;
  rename: Command;
  remove: Command;
  open: Command;
  save: Command;
}

const PICTURES: Record<string, string> = {
  undo: "M5 9h10a5 5 0 0 1 0 10h-4M5 9l4-4M5 9l4 4",
  redo: "M19 9H9a5 5 0 0 0 0 10h4M19 9l-4-4M19 9l-4 4",
  join: "M12 13 4 5M12 13l8-8M12 13v8M12 10a3 3 0 1 0 0 6 3 3 0 0 0 0-6",
  rename: "M4 20h4L19 9l-4-4L4 16zM13 7l4 4",
  remove: "M5 7h14M10 7V4h4v3M7 7l1 13h8l1-13",
  theme: "M12 4a8 8 0 1 0 0 16zM12 4a8 8 0 0 1 0 16",
};

interface HeaderProps {
  name: string;
  onName: (name: string) => void;
  theme: "light" | "dark";
  onTheme: () => void;
  commands: Commands;
}

/** The program's name, and all that can be done. */
export function Header({ name, onName, theme, onTheme, commands }: HeaderProps): ReactElement {
  return (
    <header className="bar">
      <h1>
        <a href="/">Tubeloom</a>
        <span className="unseen"> editor</span>
      </h1>
      <input
        className="name"
        aria-label="Name of the program"
        placeholder="Without a name"
        value={name}
        maxLength={500}
        onChange={(event) => onName(event.currentTarget.value)}
      />
      <div role="toolbar" aria-label="Edit">
        <Button title="Undo" keys="Ctrl+Z" picture="undo" act={commands.undo} />
        <Button title="Redo" keys="Ctrl+Shift+Z" picture="redo" act={commands.redo} />
        <i />
        <Button title="Join" keys="J" picture="join" act={commands.join} isWorded />
        <Button title="Rename" keys="F2" picture="rename" act={commands.rename} />
        <Button title="Delete" keys="Delete" picture="remove" act={commands.remove} />
      </div>
      <div className="files">
        <a className="button" href="/editor">
          New
        </a>
        <button type="button" onClick={commands.open}>
          Open
        </button>
        <button type="button" onClick={commands.save}>
          Save
        </button>
        <button
          type="button"
          aria-label="Dark theme"
          title="Dark theme"
          aria-pressed={theme === "dark"}
          onClick={onTheme}
        >
          <Picture of="theme" />
        </button>
      </div>
    </header>
  );
}

interface ButtonProps {
  title: string;
  keys: string;
  picture: string;
  act: Command;
  isWorded?: boolean;
}

function Button({ title, keys, picture, act, isWorded }: ButtonProps): ReactElement {
  return (
    <button type="button" disabled={!act} onClick={act} aria-label={title} title={`${title} (${keys})`}>
      <Picture of={picture} />
      {isWorded ? <span>{title}</span> : null}
    </button>
  );
}

function Picture({ of }: { of: string }): ReactElement {
  return (
    <svg viewBox="0 0 24 24" aria-hidden="true">
      <path d={PICTURES[of]} />
    </svg>
  );
}
