// A slider and a field for every dimension of the design in hand.

const DIGITS = { cm: 2, deg: 1, kg: 1, "": 2 };

function read(design, { owner, symbol, part, factor }) {
  const value = design[owner][symbol];
  return (part === null ? value : value[part]) * factor;
}

function write(design, { owner, symbol, part, factor }, shown) {
  const value = Number((shown / factor).toPrecision(12));
  if (part === null) design[owner][symbol] = value;
  else design[owner][symbol][part] = value;
  design.name = edited(design.name);
}

export const edited = (name) => name.replace(/-edited$/, "") + "-edited";

// Whether a field holds a number within its bounds; if not, a line below it says what they are.
export function within(field, unit = "") {
  const bad = !field.validity.valid || field.value === "";
  field.setAttribute("aria-invalid", bad);
  field.nextElementSibling?.matches(".refusal") && field.nextElementSibling.remove();
  if (bad) {
    const line = Object.assign(document.createElement("span"), { className: "refusal", role: "alert" });
    line.textContent = `must be ${+Number(field.min).toPrecision(4)} to ${+Number(field.max).toPrecision(4)} ${unit}`.replaceAll("-", "−");
    field.after(line);
  }
  return !bad;
}

export class Sliders {
  // boxes: by the table of design files; onChange: told the dimension that was changed, and whether its slider is still moved.
  constructor(boxes, dimensions, onChange) {
    this.boxes = boxes;
    this.dimensions = dimensions;
    this.onChange = onChange;
    this.rows = new Map(); // by the dimension's name
  }

  show(design) {
    const known = this.dimensions.filter(({ kinds }) => kinds.includes(design.linkage.kind));
    this.rows = new Map(known.map((dimension) => [dimension.name, row(dimension, design, this.onChange)]));
    for (const box of this.boxes) {
      box.replaceChildren(...known.filter(({ owner }) => owner === box.dataset.owner).map(({ name }) => this.rows.get(name)));
    }
  }

  // marks: names of the dimensions that are outside a limit, or keep the linkage from turning.
  mark(marks) {
    for (const [name, node] of this.rows) node.classList.toggle("outside", marks.has(name));
  }
}

function row(dimension, design, onChange) {
  const { name, words, unit, low, high, step } = dimension;
  const node = document.createElement("div"), label = document.createElement("label"), symbol = document.createElement("b");
  const slider = document.createElement("input"), number = document.createElement("input"), units = document.createElement("span");
  node.className = "dimension";
  node.dataset.name = name;
  symbol.textContent = dimension.owner === "rider" || name.length > 3 ? "" : `${name} `;
  label.append(symbol, words);
  label.htmlFor = `number-${name}`;
  Object.assign(slider, { type: "range", step: "any" });
  slider.setAttribute("aria-label", `${name} ${words}, ${unit}`);
  Object.assign(number, { type: "number", id: label.htmlFor, min: low, max: high, step: "any" });
  units.textContent = unit;
  node.append(label, slider, number, units);

  const show = () => {
    const value = read(design, dimension);
    if (!(value >= Number(slider.min) && value <= Number(slider.max))) {
      slider.min = Math.max(low, value - dimension.reach);
      slider.max = Math.min(high, value + dimension.reach);
    }
    slider.value = value;
    number.value = value.toFixed(DIGITS[unit]);
    within(number, unit);
  };
  slider.addEventListener("input", () => {
    write(design, dimension, Math.round(Number(slider.value) / step) * step);
    number.value = read(design, dimension).toFixed(DIGITS[unit]);
    within(number, unit);
    onChange(name, true);
  });
  slider.addEventListener("change", () => onChange(name, false));
  number.addEventListener("change", () => {
    if (!within(number, unit)) return;
    write(design, dimension, number.valueAsNumber);
    show();
    onChange(name, false);
  });
  Object.assign(slider, { min: 0, max: -1 }); // no value is in it
  show();
  return node;
}
