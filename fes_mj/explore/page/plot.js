// Curves over a turn of the crank, drawn as SVG: bands, lines, grid, and the crank angle that is shown.

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 40, right: 10, top: 6, bottom: 20 };

export function element(name, attributes = {}, ...children) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

// Round numbers from low to high, about `count` of them.
function ticks(low, high, count) {
  const raw = (high - low || 1) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((each) => each * power >= 0.7 * raw) * power;
  const first = Math.ceil(low / step), last = Math.floor(high / step);
  return Array.from({ length: last - first + 1 }, (_, n) => (first + n) * step);
}

export class Plot {
  // onAngle: called with the crank angle in degrees at which the plot was touched.
  constructor(svg, onAngle) {
    this.svg = svg;
    this.content = { curves: [], bands: [], levels: [], shaded: [] };
    this.angle = 0;
    const touched = (event) => {
      if (event.type === "pointermove" && !event.buttons) return;
      const box = svg.getBoundingClientRect();
      const part = (event.clientX - box.left - MARGIN.left) / (box.width - MARGIN.left - MARGIN.right);
      onAngle(Math.round(360 * Math.min(1, Math.max(0, part))) % 360);
    };
    svg.addEventListener("pointerdown", touched);
    svg.addEventListener("pointermove", touched);
    new ResizeObserver(() => this.draw()).observe(svg);
  }

  // curves: {y, colour, width, dash}; bands: {low, high, colour}; levels: {y, colour}; shaded: of each degree, whether.
  show(content) {
    this.content = { curves: [], bands: [], levels: [], shaded: [], ...content };
    this.draw();
  }

  draw() {
    const { width, height } = this.svg.getBoundingClientRect();
    if (width < 80 || height < 40) return;
    const { curves, bands, levels, shaded } = this.content;
    const all = [...curves.map((c) => c.y), ...bands.flatMap((b) => [b.low, b.high]), levels.map((l) => l.y)].flat();
    const low = all.length ? Math.min(...all) : 0, high = all.length ? Math.max(...all) : 1;
    const margin = 0.04 * (high - low || 1), bottom = low - margin, top = high + margin;
    const marks = all.length ? ticks(bottom, top, Math.max(2, Math.floor((height - 26) / 28))) : [];
    const right = width - MARGIN.right, floor = height - MARGIN.bottom;
    this.x = (degrees) => MARGIN.left + (degrees / 360) * (right - MARGIN.left);
    const y = (value) => floor - ((value - bottom) / (top - bottom || 1)) * (floor - MARGIN.top);
    const at = (value, n) => `${this.x(n).toFixed(1)},${y(value).toFixed(1)}`;
    const closed = (values) => [...values, values[0]]; // the turn closes at 360 deg
    const parts = [];
    for (const [start, end] of spans(shaded)) {
      const left = this.x(start);
      parts.push(element("rect", { x: left, y: MARGIN.top, width: this.x(end) - left, height: floor - MARGIN.top, fill: "#f3e9d2" }));
    }
    for (const value of marks) {
      parts.push(element("line", { x1: MARGIN.left, x2: right, y1: y(value), y2: y(value), class: value === 0 ? "zero" : "grid" }));
      parts.push(element("text", { x: MARGIN.left - 6, y: y(value) + 4, "text-anchor": "end" }, String(+value.toPrecision(6)).replace("-", "−")));
    }
    const step = width < 340 ? 120 : 60;
    for (let degrees = 0; degrees <= 360; degrees += step) {
      parts.push(element("text", { x: this.x(degrees), y: height - 5, "text-anchor": degrees === 360 ? "end" : "middle" }, `${degrees}°`));
    }
    for (const band of bands) {
      const up = closed(band.high).map(at), down = closed(band.low).map(at).reverse();
      parts.push(element("path", { d: `M${[...up, ...down].join("L")}Z`, fill: band.colour, "fill-opacity": 0.16 }));
    }
    for (const level of levels) {
      parts.push(element("line", { x1: MARGIN.left, x2: right, y1: y(level.y), y2: y(level.y), stroke: level.colour, "stroke-dasharray": level.dash }));
    }
    for (const curve of curves) {
      parts.push(element("path", { d: `M${closed(curve.y).map(at).join("L")}`, fill: "none", stroke: curve.colour,
        "stroke-width": curve.width, "stroke-dasharray": curve.dash || "none", "data-curve": curve.name }));
    }
    this.cursor = element("line", { y1: MARGIN.top, y2: floor, class: "cursor" });
    this.svg.replaceChildren(...parts, this.cursor);
    this.mark(this.angle);
  }

  mark(angle) {
    this.angle = angle;
    if (!this.cursor) return;
    this.cursor.setAttribute("x1", this.x(angle));
    this.cursor.setAttribute("x2", this.x(angle));
  }
}

// [first, last + 1] of every run of true values.
function spans(flags) {
  const found = [];
  flags.forEach((flag, n) => {
    if (flag && !flags[n - 1]) found.push([n, n + 1]);
    else if (flag) found.at(-1)[1] = n + 1;
  });
  return found;
}

// A button for every curve that shows or hides it, and samples of what is `fixed`. Returns where values are written.
export function legend(box, curves, unit, hidden, onToggle, fixed = []) {
  const made = [...curves, ...fixed].map((curve) => {
    const button = document.createElement("button"), value = document.createElement("b");
    const sample = element("svg", {}, element("line", { x1: 0, x2: 22, y1: 4, y2: 4, stroke: curve.colour, "stroke-width": curve.width, "stroke-dasharray": curve.dash || "none" }));
    button.type = "button";
    button.append(sample, curve.name);
    if (curve.y) {
      button.append(value);
      button.setAttribute("aria-pressed", !hidden.has(curve.name));
      button.title = "Show or hide";
      button.addEventListener("click", () => {
        if (!hidden.delete(curve.name)) hidden.add(curve.name);
        onToggle();
      });
    }
    return { button, value, y: curve.y, unit };
  });
  const held = [...box.children].indexOf(document.activeElement); // the keyboard stays where it was
  box.replaceChildren(...made.map((each) => each.button));
  made[held]?.button.focus();
  return made.filter((each) => each.y);
}
