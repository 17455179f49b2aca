/** One server-sent event. */
export interface ServerEvent {
  name: string;
  data: string;
}

/** The events of an answer, as they come. */
export async function* eventsOf(response: Response): AsyncGenerator<ServerEvent> {
  if (response.body === null) return;
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let [waiting, whole] = [[] as string[], ""];
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      waiting.push(value);
      // A picture comes in many chunks; joining them once is enough.
      if (!/\r?\n\r?\n$/.test(value) && !value.includes("\n\n")) continue;
      const blocks = (whole + waiting.join("")).replaceAll("\r\n", "\n").split("\n\n");
      waiting = [];
      whole = blocks.pop() ?? "";
      for (const block of blocks) yield eventOf(block);
    }
  } finally {
    await reader.cancel().catch(() => undefined);
  }
}

function eventOf(block: string): ServerEvent {
  let name = "message";
  const data: string[] = [];
  for (const line of block.split("\n")) {
    if (line.startsWith("event:")) name = line.slice(6).trim();
    else if (line.startsWith("data:")) data.push(line.slice(5).replace(/^ /, ""));
  }
  return { name, data: data.join("\n") };
}
