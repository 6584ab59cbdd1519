// The page: a design in hand, what the server says of it, and the two kept in step.

import { ANGLES, Scene } from "./scene.js";
import { Plot, legend } from "./plot.js";
import { Runs } from "./runs.js";
import { ask, download } from "./server.js";
import { Sliders } from "./sliders.js";

const $ = (id) => document.getElementById(id);
const copy = (value) => JSON.parse(JSON.stringify(value));
const AS_LOADED = "as loaded";
const DASH = "5 4";

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
const sliders = new Sliders($("dimensions"), start.dimensions, (dragging) => { if (!dragging) commit(); refresh(dragging); });
const runs = new Runs($("runs"), $("verdict"), () => ({ design: state.design, moments: state.moments, legs: legs() }), () => snapshot());

// ---- The design in hand

const legs = () => Number($("legs").value);

function load(design) {
  if (state.design) remember();
  const before = state.committed;
  state.loaded = copy(design);
  state.design = copy(design);
  state.committed = snapshot();
  if (before && before !== state.committed) state.history.push(before);
  showDesign();
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

function showDesign() {
  sliders.show(state.design);
  $("undo").disabled = !state.history.length;
  $("design").value = state.loaded.name;
  refresh();
}

function undo() {
  commit(); // a number that is being typed
  if (!state.history.length) return;
  state.committed = state.history.pop();
  [state.design, state.loaded] = JSON.parse(state.committed);
  showDesign();
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
  if (asked !== runs.of) runs.forget();
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
  $("error").hidden = !turn.why;
  $("error").textContent = turn.why || "";
  if (failing && !state.failing) {
    state.resume = state.playing;
    play(false);
  } else if (!failing && state.failing && state.resume) play(true);
  state.failing = failing;
  if (failing && !state.playing) state.angle = Math.round(turn.failing_deg) % ANGLES;
  showNumbers();
  redraw();
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
  sliders.mark(marks);
  $("note").textContent = own?.note ? `Note: ${own.note}.` : "";
  $("power").textContent = own ? `${own.numbers[0].text} W` : "no power";
  const change = own && other ? (100 * (own.power_mean_W - other.power_mean_W)) / Math.abs(other.power_mean_W) : NaN;
  const percent = Number.isFinite(change) && Math.abs(change) >= 0.05 ? `, ${change < 0 ? "−" : "+"}${Math.abs(change).toFixed(1)} %` : "";
  $("against").textContent = other ? `${reference.name}: ${other.power_mean_W.toFixed(2)} W${percent}` : "";
}

// ---- Curves

let entries = { power: [], joints: [] };
const redraw = () => { showPlots(); pose(); };

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
  entries.power = legend($("power-legend"), curves, "W", state.hidden, redraw);

  const range = turn.moments?.[state.moments]?.range_deg;
  const joints = Object.entries(turn.joints ?? {}).map(([name, y]) => ({ name, y, colour: start.colours[name], width: 2 }));
  const levels = range ? joints.flatMap(({ name, colour }) => range[name].map((y) => ({ y, colour, dash: "2 3" }))) : [];
  jointsPlot.show({ curves: joints.filter((curve) => !state.hidden.has(curve.name)), levels });
  entries.joints = legend($("joints-legend"), joints, "°", state.hidden, redraw, range ? [{ name: "range of the moments", dash: "2 3", colour: start.colours.reference, width: 1.2 }] : []);
  $("of-legs").textContent = turn.legs === 2 ? "(both legs; band: one standard deviation)" : "(one leg; band: one standard deviation)";
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

// files: one, or a measurement file with those that it names.
async function openMoments(...files) {
  const main = files.find((file) => file.name.endsWith(".toml")) ?? files[0];
  const texts = await Promise.all(files.map(async (file) => [file.name, await file.text()]));
  const { [main.name]: text, ...beside } = Object.fromEntries(texts);
  const answer = await ask("open-moments", { name: main.name, text, beside });
  start.moments = answer.moments;
  state.moments = answer.name;
  options($("moments"), start.moments, state.moments);
  await refresh();
  tell(answer.warnings.map((text) => `Warning: ${text}`).join(" "));
}

$("play").addEventListener("click", () => play(!state.playing));
$("angle").addEventListener("input", (event) => hold(Number(event.target.value)));
$("legs").addEventListener("change", () => refresh());
$("limits").addEventListener("change", showNumbers);
$("compared").addEventListener("change", () => refresh());
$("design").addEventListener("change", (event) => load(start.designs[event.target.value]));
$("moments").addEventListener("change", (event) => { state.moments = event.target.value; runs.forget(); showNumbers(); redraw(); });
$("undo").addEventListener("click", undo);
$("reset").addEventListener("click", () => load(state.loaded));
$("save").addEventListener("click", attempt(async () => download(await ask("save", { design: state.design }))));
$("model").addEventListener("click", attempt(async () => download(await ask("model", { design: state.design, legs: legs() }))));
for (const [button, input, action] of [["open", "open-file", openDesign], ["open-moments", "moments-file", openMoments]]) {
  $(button).addEventListener("click", () => $(input).click());
  $(input).addEventListener("change", attempt(async () => {
    const files = [...$(input).files];
    if (files.length) await action(...files);
    $(input).value = ""; // the same file may be chosen again
  }));
}
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
