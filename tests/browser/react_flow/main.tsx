import { createRoot } from "react-dom/client";
import { Editor } from "./editor";

const place = document.querySelector("#place");
if (place) createRoot(place).render(<Editor />);
