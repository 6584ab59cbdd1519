// The page: a design in hand, what the server says of it, and the two kept in step.

import { ANGLES, Scene } from "./scene.js";
import { Plot, element } from "./plot.js";

const $ = (id) => document.getElementById(id);
const copy = (value) => JSON.parse(JSON.stringify(value));
const DIGITS = { cm: 2, deg: 1, kg: 1, "": 2 };
const AS_LOADED = "as loaded";
const DASH = "5 4";

async function ask(name, question = {}) {
  let response;
  try {
    response = await fetch(name, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(question) });
  } catch {
    throw new Error("fes_mj explore has ended; start it again and reload this page");
  }
  const answer = await response.json();
  if (!response.ok) throw new Error(answer.error);
  return answer;
}

const start = await ask("start");
const state = {
  design: null, // as a design file says it, and its name
  loaded: null, // the same as it came
  committed: null, // before the change that is under way
  history: [],
  moments: start.chosen,
  hidden: new Set(),
  angle: 0,
  playing: !matchMedia("(prefers-reduced-motion: reduce)").matches,
  turn: null,
  reference: null,
};
const scene = new Scene($("scene"));
const powerPlot = new Plot($("power-plot"), (angle) => hold(angle));
const jointsPlot = new Plot($("joints-plot"), (angle) => hold(angle));

// ---- The design in hand

const legs = () => Number($("legs").value);
const read = (dimension, design = state.design) => {
  const value = design[dimension.owner][dimension.symbol];
  return (dimension.part === null ? value : value[dimension.part]) * dimension.factor;
};

function write(dimension, shown) {
  const value = Number((shown / dimension.factor).toPrecision(12)), table = state.design[dimension.owner];
  if (dimension.part === null) table[dimension.symbol] = value;
  else table[dimension.symbol][dimension.part] = value;
  state.design.name = state.loaded.name.replace(/-edited$/, "") + "-edited";
}

function load(design) {
  if (state.design) remember();
  const before = state.committed;
  state.loaded = copy(design);
  state.design = copy(design);
  state.committed = snapshot();
  if (before && before !== state.committed) state.history.push(before);
  buildDimensions();
  refresh();
}

const snapshot = () => JSON.stringify([state.design, state.loaded]);

function remember() {
  if (snapshot() === state.committed) return;
  state.history.push(state.committed);
  state.committed = snapshot();
}

function commit() {
  remember();
  $("undo").disabled = !state.history.length;
}

function undo() {
  commit(); // a number that is being typed
  if (!state.history.length) return;
  state.committed = state.history.pop();
  [state.design, state.loaded] = JSON.parse(state.committed);
  buildDimensions();
  refresh();
}

// ---- Sliders

let controls = [];

function buildDimensions() {
  const kind = state.design.linkage.kind;
  controls = start.dimensions.filter((each) => each.kinds.includes(kind)).map(control);
  const group = (words, owner) => {
    const heading = document.createElement("h2");
    heading.textContent = words;
    return [heading, ...controls.filter((each) => each.dimension.owner === owner).map((each) => each.row)];
  };
  $("dimensions").replaceChildren(...group("Linkage and seat", "linkage"), ...group("Rider", "rider"));
  $("undo").disabled = !state.history.length;
  $("design").value = state.loaded.name;
}

function control(dimension) {
  const { name, words, unit, low, high, step } = dimension;
  const row = document.createElement("div"), label = document.createElement("label"), symbol = document.createElement("b");
  const slider = document.createElement("input"), number = document.createElement("input"), units = document.createElement("span");
  row.className = "dimension";
  row.dataset.name = name;
  symbol.textContent = dimension.owner === "rider" || name.length > 3 ? "" : `${name} `;
  label.append(symbol, words);
  label.htmlFor = `number-${name}`;
  Object.assign(slider, { type: "range", step: "any" });
  slider.setAttribute("aria-label", `${name} ${words}`);
  Object.assign(number, { type: "number", id: label.htmlFor, min: low, max: high, step });
  number.title = `${+low.toPrecision(4)} to ${+high.toPrecision(4)} ${unit}`;
  units.textContent = unit;
  row.append(label, slider, number, units);

  const show = () => {
    const value = read(dimension);
    if (!(value >= Number(slider.min) && value <= Number(slider.max))) {
      slider.min = Math.max(low, value - dimension.reach);
      slider.max = Math.min(high, value + dimension.reach);
    }
    slider.value = value;
    number.value = value.toFixed(DIGITS[unit]);
  };
  slider.addEventListener("input", () => {
    write(dimension, Math.round(Number(slider.value) / step) * step);
    number.value = read(dimension).toFixed(DIGITS[unit]);
    refresh(true);
  });
  slider.addEventListener("change", () => { commit(); refresh(); });
  number.addEventListener("change", () => {
    const asked = number.valueAsNumber;
    if (Number.isFinite(asked)) write(dimension, Math.min(high, Math.max(low, asked)));
    show();
    commit();
    refresh();
  });
  Object.assign(slider, { min: 0, max: -1 }); // no value is in it
  show();
  return { dimension, row };
}

// ---- What the server says of it

let busy = false, again = null;

// dragging: a slider is being moved; the picture then keeps its frame.
async function refresh(dragging = false) {
  if (busy) { again = { dragging }; return; }
  busy = true;
  const asked = snapshot(), question = { design: copy(state.design), legs: legs() };
  try {
    await compare(question.legs);
    state.turn = { legs: question.legs, ...(await ask("turn", question)) };
    tell("");
    show(dragging);
  } catch (error) {
    tell(error.message);
  }
  busy = false;
  if (asked !== state.ran) staleVerdict();
  const next = again;
  again = null;
  if (next) refresh(next.dragging);
  else document.body.dataset.updates = Number(document.body.dataset.updates || 0) + 1;
}

async function compare(legs) {
  const chosen = $("compared").value, design = chosen === AS_LOADED ? state.loaded : start.designs[chosen];
  const key = JSON.stringify([design, legs, start.moments]);
  if (state.reference?.key === key) return;
  state.reference = { key, name: chosen === AS_LOADED ? `${design.name} as loaded` : chosen, turn: await ask("turn", { design, legs }) };
}

function show(dragging) {
  const { turn } = state;
  const failing = turn.failing_deg !== null;
  scene.show(turn, turn.legs, dragging);
  $("error").hidden = !turn.error;
  $("error").textContent = turn.error || "";
  if (failing && !state.failing) {
    state.resume = state.playing;
    play(false);
  } else if (!failing && state.failing && state.resume) play(true);
  state.failing = failing;
  if (failing && !state.playing) state.angle = Math.round(turn.failing_deg) % ANGLES;
  showNumbers();
  showPlots();
  pose();
}

function showNumbers() {
  const { turn, reference } = state, own = turn.moments?.[state.moments], other = reference.turn.moments?.[state.moments];
  const broken = $("limits").checked ? turn.broken : [], marks = new Set(broken.flatMap((each) => each.marks));
  $("title").textContent = state.design.name;
  $("numbers").replaceChildren(...[...(own?.numbers ?? []), ...(turn.numbers ?? [])].map(({ name, words, text, unit }) => {
    const row = document.createElement("tr");
    row.dataset.name = name;
    row.classList.toggle("outside", marks.has(name));
    for (const content of [words, text, unit]) row.insertCell().textContent = content;
    return row;
  }));
  $("broken").replaceChildren(...broken.map(({ text }) => Object.assign(document.createElement("li"), { textContent: text })));
  for (const { dimension, row } of controls) row.classList.toggle("outside", marks.has(dimension.name));
  $("note").textContent = own?.note ? `Note: ${own.note}.` : "";
  $("power").textContent = own ? `${own.numbers[0].text} W` : "no power";
  const change = own && other ? (100 * (own.power_mean_W - other.power_mean_W)) / Math.abs(other.power_mean_W) : NaN;
  const percent = Number.isFinite(change) && Math.abs(change) >= 0.05 ? `, ${change < 0 ? "−" : "+"}${Math.abs(change).toFixed(1)} %` : "";
  $("against").textContent = other ? `${reference.name}: ${other.power_mean_W.toFixed(2)} W${percent}` : "";
}

// ---- Curves

let entries = { power: [], joints: [] };

function showPlots() {
  const { turn, reference } = state, curves = [], bands = [];
  start.moments.forEach((name, place) => {
    const of = turn.moments?.[name], colour = start.series[place % start.series.length], chosen = name === state.moments;
    if (!of) return;
    const width = chosen ? 2.4 : 1.3;
    const masses = { name: `${name} with masses`, y: of.masses, colour, width };
    curves.push(masses, { name: `${name} quasi-static`, y: of.static, colour, width: width * 0.8, dash: DASH });
    if (of.sd && !state.hidden.has(masses.name)) {
      bands.push({ low: of.masses.map((y, n) => y - of.sd[n]), high: of.masses.map((y, n) => y + of.sd[n]), colour });
    }
  });
  const other = reference.turn.moments?.[state.moments];
  if (other) curves.unshift({ name: reference.name, y: other.masses, colour: start.colours.reference, width: 1.2 });
  const visible = curves.filter((curve) => !state.hidden.has(curve.name));
  powerPlot.show({ curves: visible, bands, levels: [{ y: 0, colour: "none" }], shaded: turn.moments?.[state.moments]?.outside ?? [] });
  entries.power = legend($("power-legend"), curves, "W");

  const range = turn.moments?.[state.moments]?.range_deg;
  const joints = Object.entries(turn.joints ?? {}).map(([name, y]) => ({ name, y, colour: start.colours[name], width: 2 }));
  const levels = range ? joints.flatMap(({ name, colour }) => range[name].map((y) => ({ y, colour, dash: "2 3" }))) : [];
  jointsPlot.show({ curves: joints.filter((curve) => !state.hidden.has(curve.name)), levels });
  entries.joints = legend($("joints-legend"), joints, "°", range ? [{ name: "range of the moments", dash: "2 3", colour: start.colours.reference, width: 1.2 }] : []);
  $("of-legs").textContent = turn.legs === 2 ? "(both legs; band: one standard deviation)" : "(one leg; band: one standard deviation)";
}

function legend(box, curves, unit, fixed = []) {
  const made = [...curves, ...fixed].map((curve) => {
    const button = document.createElement("button"), value = document.createElement("b");
    const sample = element("svg", {}, element("line", { x1: 0, x2: 22, y1: 4, y2: 4, stroke: curve.colour, "stroke-width": curve.width, "stroke-dasharray": curve.dash || "none" }));
    button.type = "button";
    button.append(sample, curve.name);
    if (curve.y) {
      button.append(value);
      button.setAttribute("aria-pressed", !state.hidden.has(curve.name));
      button.title = "Show or hide";
      button.addEventListener("click", () => {
        if (!state.hidden.delete(curve.name)) state.hidden.add(curve.name);
        showPlots();
        pose();
      });
    }
    return { button, value, y: curve.y, unit };
  });
  box.replaceChildren(...made.map((each) => each.button));
  return made.filter((each) => each.y);
}

// ---- Motion

function pose() {
  const n = Math.round(state.angle) % ANGLES;
  scene.pose(n);
  powerPlot.mark(n);
  jointsPlot.mark(n);
  $("angle").value = n;
  $("angle-shown").textContent = `${n} deg`;
  for (const { value, y, unit } of [...entries.power, ...entries.joints]) {
    value.textContent = `${y[n].toFixed(1).replace("-", "−")}${unit === "W" ? " W" : unit}`;
  }
}

function play(on) {
  state.playing = on;
  $("play").textContent = on ? "Pause" : "Play";
  $("play").setAttribute("aria-pressed", on);
}

function hold(angle) {
  play(false);
  state.resume = false;
  state.angle = angle;
  pose();
}

let last = performance.now();
function frame(now) {
  const seconds = Math.min(0.1, (now - last) / 1000);
  last = now;
  if (state.playing && state.turn) {
    state.angle = (state.angle + seconds * 6 * state.turn.cadence_rpm * Number($("speed").value)) % ANGLES;
    pose();
  }
  requestAnimationFrame(frame);
}

// ---- Files and runs

function tell(text) {
  $("message").textContent = text;
  $("message").hidden = !text;
}

const attempt = (action) => async (...event) => {
  try {
    await action(...event);
  } catch (error) {
    tell(error.message);
  }
};

function download({ name, text }) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text]));
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}

function options(select, names, chosen, words = (name) => name) {
  select.replaceChildren(...names.map((name) => new Option(words(name), name)));
  select.value = chosen;
}

function showDesigns() {
  const compared = $("compared").value || AS_LOADED;
  options($("design"), Object.keys(start.designs), state.loaded?.name ?? start.design, (name) => name);
  options($("compared"), [AS_LOADED, ...Object.keys(start.designs)], compared, (name) => (name === AS_LOADED ? "itself, as loaded" : name));
}

async function openDesign(file) {
  const { design } = await ask("open-design", { name: file.name, text: await file.text() });
  start.designs[design.name] = design;
  load(design);
  showDesigns();
}

async function openMoments(file) {
  const answer = await ask("open-moments", { name: file.name, text: await file.text() });
  start.moments = answer.moments;
  state.moments = answer.name;
  options($("moments"), start.moments, state.moments);
  await refresh();
  tell(answer.warnings.map((text) => `Warning: ${text}`).join(" "));
}

function staleVerdict() {
  const box = $("verdict");
  if (box.childElementCount && !box.dataset.running) box.replaceChildren();
}

async function run(button) {
  const box = $("verdict"), buttons = [...$("runs").querySelectorAll("button")], asked = snapshot();
  const line = document.createElement("p");
  state.ran = asked;
  buttons.forEach((each) => (each.disabled = true));
  line.textContent = `${button.textContent}: ${state.design.name} is running…`;
  box.dataset.running = true;
  box.replaceChildren(line);
  try {
    const answer = await ask(button.dataset.run, { design: state.design, moments: state.moments, legs: legs() });
    line.className = answer.agrees ? "good" : "bad";
    line.textContent = `${asked === snapshot() ? "" : "Of the design as it was: "}${answer.verdict}`;
    const table = document.createElement("table"), head = table.createTHead().insertRow();
    for (const text of ["check", "value", "limit", ""]) head.append(Object.assign(document.createElement("th"), { textContent: text }));
    for (const { name, value, limit, ok } of answer.checks) {
      const row = table.insertRow();
      for (const text of [name, value, limit, ok ? "ok" : "FAILED"]) row.insertCell().textContent = text;
      row.lastChild.className = ok ? "good" : "bad";
    }
    box.append(table);
  } catch (error) {
    line.className = "bad";
    line.textContent = error.message;
  }
  delete box.dataset.running;
  buttons.forEach((each) => (each.disabled = false));
}

$("play").addEventListener("click", () => play(!state.playing));
$("angle").addEventListener("input", (event) => hold(Number(event.target.value)));
$("legs").addEventListener("change", () => refresh());
$("limits").addEventListener("change", showNumbers);
$("compared").addEventListener("change", () => refresh());
$("design").addEventListener("change", (event) => load(start.designs[event.target.value]));
$("moments").addEventListener("change", (event) => { state.moments = event.target.value; staleVerdict(); showNumbers(); showPlots(); pose(); });
$("undo").addEventListener("click", undo);
$("reset").addEventListener("click", () => load(state.loaded));
$("save").addEventListener("click", attempt(async () => download(await ask("save", { design: state.design }))));
$("model").addEventListener("click", attempt(async () => download(await ask("model", { design: state.design, legs: legs() }))));
for (const [button, input, action] of [["open", "open-file", openDesign], ["open-moments", "moments-file", openMoments]]) {
  $(button).addEventListener("click", () => $(input).click());
  $(input).addEventListener("change", attempt(async () => {
    const [file] = $(input).files;
    if (file) await action(file);
    $(input).value = ""; // the same file may be chosen again
  }));
}
for (const button of $("runs").querySelectorAll("button")) button.addEventListener("click", () => run(button));
document.addEventListener("keydown", (event) => {
  if ((event.ctrlKey || event.metaKey) && event.key === "z" && event.target.type !== "number") {
    event.preventDefault();
    undo();
  }
});

options($("moments"), start.moments, start.chosen);
showDesigns();
play(state.playing);
load(start.designs[start.design]);
requestAnimationFrame(frame);
