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
  design.name = design.name.replace(/-edited$/, "") + "-edited";
}

export class Sliders {
  // onChange: called when a dimension was changed, with whether its slider is still being moved.
  constructor(box, dimensions, onChange) {
    this.box = box;
    this.dimensions = dimensions;
    this.onChange = onChange;
    this.rows = new Map(); // by the dimension's name
  }

  show(design) {
    const known = this.dimensions.filter((each) => each.kinds.includes(design.linkage.kind));
    this.rows = new Map(known.map((each) => [each.name, row(each, design, this.onChange)]));
    const group = (words, owner) => {
      const heading = document.createElement("h2");
      heading.textContent = words;
      return [heading, ...known.filter((each) => each.owner === owner).map((each) => this.rows.get(each.name))];
    };
    this.box.replaceChildren(...group("Linkage and seat", "linkage"), ...group("Rider", "rider"));
  }

  // marks: names of the dimensions that are outside a limit.
  mark(marks) {
    for (const [name, made] of this.rows) made.classList.toggle("outside", marks.has(name));
  }
}

function row(dimension, design, onChange) {
  const { name, words, unit, low, high, step } = dimension;
  const made = document.createElement("div"), label = document.createElement("label"), symbol = document.createElement("b");
  const slider = document.createElement("input"), number = document.createElement("input"), units = document.createElement("span");
  made.className = "dimension";
  made.dataset.name = name;
  symbol.textContent = dimension.owner === "rider" || name.length > 3 ? "" : `${name} `;
  label.append(symbol, words);
  label.htmlFor = `number-${name}`;
  Object.assign(slider, { type: "range", step: "any" });
  slider.setAttribute("aria-label", `${name} ${words}`);
  Object.assign(number, { type: "number", id: label.htmlFor, min: low, max: high, step });
  number.title = `${+low.toPrecision(4)} to ${+high.toPrecision(4)} ${unit}`;
  units.textContent = unit;
  made.append(label, slider, number, units);

  const show = () => {
    const value = read(design, dimension);
    if (!(value >= Number(slider.min) && value <= Number(slider.max))) {
      slider.min = Math.max(low, value - dimension.reach);
      slider.max = Math.min(high, value + dimension.reach);
    }
    slider.value = value;
    number.value = value.toFixed(DIGITS[unit]);
  };
  slider.addEventListener("input", () => {
    write(design, dimension, Math.round(Number(slider.value) / step) * step);
    number.value = read(design, dimension).toFixed(DIGITS[unit]);
    onChange(true);
  });
  slider.addEventListener("change", () => onChange(false));
  number.addEventListener("change", () => {
    const asked = number.valueAsNumber;
    if (Number.isFinite(asked)) write(design, dimension, Math.min(high, Math.max(low, asked)));
    show();
    onChange(false);
  });
  Object.assign(slider, { min: 0, max: -1 }); // no value is in it
  show();
  return made;
}
