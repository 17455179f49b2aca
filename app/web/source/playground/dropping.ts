/** Takes files that are dropped anywhere on the page, or chosen. */
export function takeFiles(
  veil: HTMLElement,
  button: HTMLButtonElement,
  input: HTMLInputElement,
  taken: (contents: string, name: string) => void,
): void {
  const take = async (file: File | undefined) => {
    if (file) taken(await file.text(), file.name);
  };
  button.addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    void take(input.files?.[0]);
    input.value = "";
  });
  const on = <Name extends "dragenter" | "dragover" | "dragleave" | "drop">(
    name: Name,
    act: (event: DragEvent) => void,
  ) => {
    const heed = (event: DragEvent) => {
      if (!event.dataTransfer?.types.includes("Files")) return;
      // Else the editor would take the file too, as text at the cursor.
      event.preventDefault();
      event.stopPropagation();
      act(event);
    };
    window.addEventListener(name, heed, true);
  };
  on("dragenter", () => (veil.hidden = false));
  on("dragover", () => (veil.hidden = false));
  on("dragleave", ({ relatedTarget }) => {
    if (relatedTarget === null) veil.hidden = true;
  });
  on("drop", ({ dataTransfer }) => {
    veil.hidden = true;
    void take(dataTransfer?.files[0]);
  });
}
