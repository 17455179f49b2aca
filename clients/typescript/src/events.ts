/** One server-sent event: its name, its data as JSON, and the id of the last event that had one. */
export interface ServerEvent {
  name: string;
  data: unknown;
  id: string | undefined;
}

/** Makes events of the text of a stream; `lastId` is where to go on after a break. */
export class EventReader {
  lastId: string | undefined;
  #id: string | undefined;
  #rest = "";
  #name = "";
  #data: string[] = [];

  constructor(lastId?: string) {
    this.lastId = this.#id = lastId;
  }

  /** Forget the event that was not finished: it will come again. */
  interrupted(): void {
    this.#rest = this.#name = "";
    this.#data = [];
    this.#id = this.lastId;
  }

  /** The events that `piece` completes. */
  *feed(piece: string): Generator<ServerEvent> {
    const lines = (this.#rest + piece).split("\n");
    this.#rest = lines.pop() ?? "";
    for (const line of lines) {
      const event = this.#line(line.endsWith("\r") ? line.slice(0, -1) : line);
      if (event) yield event;
    }
  }

  #line(line: string): ServerEvent | undefined {
    if (line === "") return this.#finish();
    const colon = line.indexOf(":");
    const field = colon < 0 ? line : line.slice(0, colon);
    const value = colon < 0 ? "" : line.slice(colon + 1).replace(/^ /, "");
    if (field === "event") this.#name = value;
    else if (field === "data") this.#data.push(value);
    else if (field === "id") this.#id = value;
    return undefined;
  }

  #finish(): ServerEvent | undefined {
    const [name, data] = [this.#name || "message", this.#data];
    this.#name = "";
    this.#data = [];
    this.lastId = this.#id;
    if (data.length === 0) return undefined;
    return { name, data: JSON.parse(data.join("\n")) as unknown, id: this.lastId };
  }
}
