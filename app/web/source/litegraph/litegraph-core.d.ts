/** The part of litegraph.js without its hundreds of ready-made nodes, some of which compile strings. */
declare module "litegraph.js/build/litegraph.core.js" {
  export * from "litegraph.js";
}
