// Leg and linkage in their plane. Coordinates are metres, x backwards: pictures show it to the left, y up.

import { element } from "./plot.js";

export const ANGLES = 360;
const MARGIN = 0.16; // m around the joints, for flesh and boot

export class Scene {
  // space: where the pivots may lie, x and y of its corners.
  constructor(svg, space) {
    this.svg = svg;
    this.space = space;
    this.plane = element("g", { transform: "scale(-1,-1)" });
    svg.append(this.plane);
  }

  // turn: the answer's bodies, bars, pins, dyads, pedal. hold: keep the frame while a dimension is dragged. bounded:
  // draw the design space.
  show(turn, legs, hold, bounded) {
    this.turn = turn;
    this.bounded = bounded;
    this.legs = [];
    const fixed = turn.bars.filter((bar) => bar.body === "").map((bar) => drawn(bar));
    const nodes = [...(bounded ? [closed("space", this.space)] : []), ...fixed];
    for (let leg = legs - 1; leg >= 0; leg--) {
      const parts = turn.bars.filter((bar) => bar.body !== "").map((bar) => ({ body: bar.body, node: drawn(bar) }));
      const pins = turn.pins.map((pin) => ({ ...pin, node: element("circle", { r: pin.radius, fill: pin.colour }) }));
      const gaps = turn.dyads.map((dyad) => ({ dyad, node: element("line", { class: "gap" }) }));
      const all = [...parts, ...pins, ...gaps].map((each) => each.node);
      nodes.push(element("g", { class: leg ? "far" : "near" }, ...all));
      this.legs.push({ lag: (leg * ANGLES) / 2, parts, pins, gaps });
    }
    if (turn.failing === null) nodes.push(...this.paths());
    nodes.push(this.arrow());
    this.plane.replaceChildren(...nodes);
    if (!hold || !this.framed) this.frame();
  }

  // The pedal's path, and the coupler curve: of the coupler's middle where the pedal is not on the coupler.
  paths() {
    const { bodies, pedal, pedal_on } = this.turn;
    const curves = [{ name: "pedal", xy: pedal }];
    if (bodies.coupler && pedal_on !== "coupler") {
      const [[x0, y0], [x1, y1]] = bodies.coupler;
      curves.push({ name: "coupler", xy: [x0.map((x, n) => (x + x1[n]) / 2), y0.map((y, n) => (y + y1[n]) / 2)] });
    }
    return curves.map(({ name, xy }) => closed(`path ${name}`, xy));
  }

  // Which way the crank turns: counter-clockwise with x backwards, so that the pedal at the top moves forwards.
  arrow() {
    const [[x], [y]] = this.turn.bodies.crank[0], radius = 0.1, reach = 0.9, size = 0.035;
    const on = (angle) => [x - radius * Math.sin(angle), y + radius * Math.cos(angle)];
    const end = on(reach);
    const wing = (turn) => [end[0] + size * Math.cos(reach + turn), end[1] + size * Math.sin(reach + turn)];
    const d = `M${on(-reach)}A${radius},${radius} 0 0 1 ${end}M${wing(0.5)}L${end}L${wing(-0.5)}`;
    return element("path", { class: "turning", d });
  }

  frame() {
    const [xs, ys] = this.bounded ? this.space.map((values) => [...values]) : [[], []];
    for (const [from, to] of Object.values(this.turn.bodies)) {
      xs.push(...from[0], ...to[0]);
      ys.push(...from[1], ...to[1]);
    }
    for (const bar of this.turn.bars.filter((each) => each.body === "")) {
      xs.push(bar.line[0], bar.line[2]);
      ys.push(bar.line[1], bar.line[3]);
    }
    const left = -Math.max(...xs) - MARGIN, top = -Math.max(...ys) - MARGIN;
    this.svg.setAttribute("viewBox", [left, top, -Math.min(...xs) + MARGIN - left, -Math.min(...ys) + MARGIN - top].join(" "));
    this.framed = true;
  }

  // Put everything where it is at a crank angle, degrees.
  pose(angle) {
    if (!this.turn) return;
    for (const { lag, parts, pins, gaps } of this.legs) {
      // the legs share the crank; the other leg is where this one was half a turn ago
      const n = (((Math.round(angle) - lag) % ANGLES) + ANGLES) % ANGLES;
      const at = (body, end) => this.turn.bodies[body][end].map((values) => values[n]);
      for (const { body, node } of parts) {
        const [x, y] = at(body, 0), [tipX, tipY] = at(body, 1);
        const turn = (Math.atan2(tipY - y, tipX - x) * 180) / Math.PI;
        node.setAttribute("transform", `translate(${x} ${y}) rotate(${turn})`);
      }
      for (const { body, end, node } of pins) {
        const [x, y] = at(body, end);
        node.setAttribute("cx", x);
        node.setAttribute("cy", y);
      }
      for (const { dyad, node } of gaps) {
        const [x1, y1] = at(dyad[0], 1), [x2, y2] = at(dyad[1], 0);
        const open = Math.hypot(x2 - x1, y2 - y1) > 2e-4; // more than the rounding of the positions
        for (const [key, value] of Object.entries({ x1, y1, x2, y2 })) node.setAttribute(key, value);
        node.style.display = open ? "" : "none";
      }
    }
  }
}

function closed(name, [xs, ys]) {
  return element("path", { class: name, d: `M${xs.map((x, n) => `${x},${ys[n]}`).join("L")}Z` });
}

function drawn(bar) {
  const [x1, y1, x2, y2] = bar.line;
  return element("line", { x1, y1, x2, y2, stroke: bar.colour, "stroke-width": bar.width, "stroke-linecap": "round", "data-body": bar.body });
}
