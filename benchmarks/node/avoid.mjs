// Routes hyperedges around blocks with libavoid, orthogonally, improving where its junctions are:
// one JSON document a line in, one a line out. Blocks stay; a hyperedge is a star around a junction.
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import { AvoidLib } from 'libavoid-js';

const WASM = new URL('node_modules/libavoid-js/dist/libavoid.wasm', import.meta.url);
await AvoidLib.load(fileURLToPath(WASM));
const Avoid = AvoidLib.getInstance();
const SCALE = 100; // libavoid nudges by whole units
const ALL = Avoid.ConnDirAll;

function route({ items, hyperedges }) {
  const router = new Avoid.Router(Avoid.OrthogonalRouting);
  router.setRoutingParameter(Avoid.idealNudgingDistance, 0.45 * SCALE);
  router.setRoutingParameter(Avoid.shapeBufferDistance, 0.25 * SCALE);
  router.setRoutingOption(Avoid.improveHyperedgeRoutesMovingJunctions, true);
  router.setRoutingOption(Avoid.nudgeOrthogonalSegmentsConnectedToShapes, true);
  const point = ([x, y]) => new Avoid.Point(x * SCALE, y * SCALE);
  const shapes = items.map(
    ([x, y, width, height]) =>
      new Avoid.ShapeRef(
        router,
        new Avoid.Rectangle(point([x, y]), width * SCALE, height * SCALE),
      ),
  );
  const lines = hyperedges.flatMap((ends, k) => {
    const pins = ends.map(([item, x, y], n) => {
      const [left, top, width, height] = items[item];
      const id = 1 + 8 * k + n;
      // A pin of its own at the attachment's place on its block.
      new Avoid.ShapeConnectionPin(
        shapes[item], id,
        (x - left) / width + 0.5, (y - top) / height + 0.5, true, 0, ALL,
      );
      return new Avoid.ConnEnd(shapes[item], id);
    });
    if (pins.length === 2) return [[k, new Avoid.ConnRef(router, pins[0], pins[1])]];
    const middle = [1, 2].map((axis) => ends.reduce((sum, end) => sum + end[axis], 0) / ends.length);
    const junction = new Avoid.JunctionRef(router, point(middle));
    const center = () => Avoid.ConnEnd.prototype.createConnEndFromJunctionRef(junction);
    return pins.map((pin) => [k, new Avoid.ConnRef(router, pin, center())]);
  });
  router.processTransaction();
  return lines.map(([k, line]) => {
    const found = line.displayRoute();
    const at = Array.from({ length: found.size() }, (_, n) => found.get_ps(n));
    return [k, at.map(({ x, y }) => [x / SCALE, y / SCALE])];
  });
}

for await (const line of createInterface({ input: process.stdin })) {
  process.stdout.write(`${JSON.stringify(route(JSON.parse(line)))}\n`);
}
