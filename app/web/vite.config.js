import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

export default defineConfig({
  root: here("source"),
  base: "/",
  resolve: {
    alias: {
      "tubeloom-client": here("../../clients/typescript/src/index.ts"),
      "tubeloom-react-flow": here("../../clients/react-flow/src/index.ts"),
    },
    // The adapter lies elsewhere, and uses the editor's own copy of what both need.
    dedupe: ["react", "react-dom", "@xyflow/react"],
  },
  build: {
    outDir: here("built"),
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    assetsDir: "web",
    // What the pages are made of is other people's work too: their licences come along.
    license: { fileName: "licenses.md" },
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 900,
    rolldownOptions: {
      onwarn(warning, warn) {
        // litegraph.js reads numbers that people type into its widgets by eval; pages forbid that.
        if (warning.code === "EVAL" && /\/litegraph\.js\//.test(warning.message)) return;
        warn(warning);
      },
      input: {
        index: here("source/index.html"),
        viewer: here("source/viewer.html"),
        editor: here("source/editor.html"),
        litegraph: here("source/litegraph.html"),
        "tube-viewer": here("source/tube-viewer.ts"),
      },
      output: {
        // Pages of others name this file; all else is named by its contents.
        entryFileNames: ({ name }) =>
          name === "tube-viewer" ? "tube-viewer.js" : "web/[name]-[hash].js",
      },
      preserveEntrySignatures: "strict",
    },
  },
  server: { proxy: { "/v1": "http://127.0.0.1:8000" } },
});
