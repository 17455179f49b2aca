import ours from "PAGES/vite.config.js";

const here = import.meta.dirname;

export default {
  ...ours,
  root: here,
  build: { outDir: `${here}/built`, target: ours.build.target, chunkSizeWarningLimit: 900 },
};
