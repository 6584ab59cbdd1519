// The page: a design in hand, what the server says of it, and the two kept in step.

import { ANGLES, Scene } from "./scene.js";
import { Plot, legend } from "./plot.js";
import { Making } from "./making.js";
import { REST, Rested } from "./rested.js";
import { Runs } from "./runs.js";
import { ask, download } from "./server.js";
import { Sliders, edited, within } from "./sliders.js";

const $ = (id) => document.getElementById(id);
const copy = (value) => JSON.parse(JSON.stringify(value));
const AS_LOADED = "as loaded";
const DASH = "5 4";

function tell(text) {
  $("message").textContent = text;
  $("message").hidden = !text;
}

const start = await ask("start").catch((error) => {
  tell(error.message);
  throw error;
});
const state = {
  design: null, // as a design file says it, and its name
  loaded: null, // the same as it came
  touched: null, // the dimension that was changed last
  moments: start.chosen,
  drive: start.drive,
  numbers: null, // with their intervals, and what muscles do, when that has been computed
  hidden: new Set(),
  angle: 0,
  playing: !matchMedia("(prefers-reduced-motion: reduce)").matches,
  turn: null,
  reference: null,
};
const scene = new Scene($("scene"), start.space);
const powerPlot = new Plot($("power-plot"), (angle) => hold(angle));
const jointsPlot = new Plot($("joints-plot"), (angle) => hold(angle));
const sliders = new Sliders(document.querySelectorAll("[data-owner]"), start.dimensions, changed);
const making = new Making($("making"), (angle) => hold(angle));
const clearances = new Rested("making", (answer) => making.show(answer));
const numbers = new Rested("numbers", (answer) => {
  if (answer === state.numbers) return; // none yet
  state.numbers = answer;
  showNumbers();
  redraw();
});
const runs = new Runs($("runs"), $("verdict"), asRun, () => JSON.stringify(asked()), take);

// ---- The design in hand. What it was stands in the browser's history, and in the address so that it can be sent.

const legs = () => Number($("legs").value);
const asked = () => ({ design: state.design, legs: legs(), moments: state.moments, drive: state.drive });
const address = () => `#${encodeURIComponent(JSON.stringify(asked()))}`;

function snapshot() {
  return JSON.stringify([state.design, state.loaded]);
}

function asRun() {
  if (!within($("slope"), "%")) return null;
  return { ...asked(), slope: $("slope").valueAsNumber, transmission: $("transmission").value };
}

let resting;
function changed(name, dragging) {
  state.touched = name;
  tell("");
  clearTimeout(resting);
  if (!dragging) resting = setTimeout(commit, REST); // then it is an entry of the browser's history
  $("undo").disabled = false;
  refresh(dragging);
}

// Make the design in hand an entry of the history, unless it is that already.
function commit() {
  clearTimeout(resting);
  const entry = { design: state.design, loaded: state.loaded, place: (history.state?.place ?? -1) + 1 };
  if (JSON.stringify([history.state?.design, history.state?.loaded]) !== snapshot()) history.pushState(entry, "", address());
  $("undo").disabled = !history.state.place;
}

// Take another design into the hand, `loaded` if it comes from a file or a list.
function take(design, loaded = state.loaded) {
  tell("");
  commit();
  Object.assign(state, { design: copy(design), loaded: copy(loaded), touched: null });
  commit();
  showDesign();
}

const load = (design) => take(design, design);

async function change(question) {
  const { design } = await ask("change", { design: state.design, ...question });
  take({ ...design, name: edited(design.name) });
}

function showDesign() {
  const { kind, branch } = state.design.linkage;
  sliders.show(state.design);
  $("undo").disabled = !history.state.place;
  $("design").value = state.loaded.name;
  $("kind").value = kind;
  $("branch").value = branch ?? "left";
  $("of-branch").hidden = kind === "trt";
  $("sex").value = state.design.rider.sex;
  refresh();
}

function undo() {
  commit(); // what is being changed
  if (history.state.place) history.back();
}

// What the address says, or what was here before a reload; the server makes it whole, or refuses it.
async function arrive() {
  try {
    const sent = location.hash ? JSON.parse(decodeURIComponent(location.hash.slice(1))) : {};
    const { design } = await ask("change", { design: sent.design ?? start.designs[start.design] });
    if (start.moments.includes(sent.moments)) state.moments = sent.moments;
    if (sent.legs === 2) $("legs").value = "2";
    if (sent.drive === "muscles" || sent.drive === "moments") state.drive = sent.drive;
    Object.assign(state, { design, loaded: history.state?.loaded ?? copy(design), touched: null });
  } catch (error) {
    state.design = copy((state.loaded = start.designs[start.design]));
    tell(`The address holds no design: ${error.message}`);
  }
  const { design, loaded } = state;
  history.replaceState({ design, loaded, place: history.state?.place ?? 0 }, "", address());
  options($("moments"), start.moments, state.moments);
  $("drive").value = state.drive;
  showDesigns();
  showDesign();
}

// ---- What the server says of it

let busy = false, again = null;

// dragging: a slider is being moved; the picture then keeps its frame.
async function refresh(dragging = false) {
  if (busy) { again = { dragging }; return; }
  busy = true;
  const question = copy(asked());
  try {
    await compare(question.legs);
    state.turn = { legs: question.legs, ...(await ask("turn", question)) };
    if (!dragging) history.replaceState(history.state, "", address());
    show(dragging);
  } catch (error) {
    tell(error.message);
  }
  busy = false;
  runs.compare();
  askRested();
  const next = again;
  again = null;
  if (next) refresh(next.dragging);
  else document.body.dataset.updates = Number(document.body.dataset.updates || 0) + 1;
}

// What takes longer than a curve may.
function askRested() {
  const turns = Boolean(state.turn?.moments), { design, moments } = state;
  $("making").hidden = !turns;
  clearances.ask(turns ? { design, moments } : null);
  numbers.ask(turns ? { ...asked(), compared: compared() } : null);
}

function compared() {
  const chosen = $("compared").value;
  return chosen === AS_LOADED ? state.loaded : start.designs[chosen];
}

async function compare(legs) {
  const chosen = $("compared").value, design = compared();
  const key = JSON.stringify([design, legs, start.moments]);
  if (state.reference?.key === key) return;
  state.reference = { key, name: chosen === AS_LOADED ? `${design.name} as loaded` : chosen, turn: await ask("turn", { design, legs }) };
}

function show(dragging) {
  const { turn } = state;
  const failing = turn.failing !== null;
  scene.show(turn, turn.legs, dragging, $("limits").checked && state.design.linkage.kind !== "trt");
  if (turn.moments && !turn.moments[state.moments]) forgotten();
  $("error").hidden = !turn.why;
  $("error").textContent = turn.why ?? "";
  if (failing && !state.failing) {
    state.resume = state.playing;
    play(false);
  } else if (!failing && state.failing && state.resume) play(true);
  state.failing = failing;
  if (failing && !state.playing) state.angle = Math.round(turn.failing.deg) % ANGLES;
  showNumbers();
  redraw();
}

// The server keeps a file of moments for some hours after its last use.
function forgotten() {
  tell(`${state.moments} is no longer known; open its file again`);
  start.moments = Object.keys(state.turn.moments);
  state.moments = start.moments[0];
  options($("moments"), start.moments, state.moments);
}

function showNumbers() {
  const { turn, reference } = state, own = turn.moments?.[state.moments], other = reference.turn.moments?.[state.moments];
  const broken = $("limits").checked && !turn.failing ? turn.broken : [];
  const marks = new Set(turn.failing ? [state.touched] : broken.flatMap((limit) => limit.marks));
  $("title").textContent = state.design.name;
  const { windows = [], why } = state.numbers ?? {};
  showBoth(Boolean(own));
  $("numbers").replaceChildren(...[...windows, ...(own?.numbers ?? []), ...(turn.numbers ?? [])].map(({ name, words, text, unit }) => {
    const row = document.createElement("tr");
    row.dataset.name = name;
    row.classList.toggle("outside", marks.has(name));
    for (const content of [words, text, unit]) row.insertCell().textContent = content;
    return row;
  }));
  $("broken").replaceChildren(...broken.map(({ text }) => Object.assign(document.createElement("li"), { textContent: text })));
  sliders.mark(marks);
  $("note").textContent = [own?.note && `Note: ${own.note}.`, why && `For a rider: ${why}.`].filter(Boolean).join(" ");
  headline(own, other);
}

// Both powers with the intervals in which nine of ten draws of what is not known lie.
function showBoth(turns) {
  const waiting = turns && !state.numbers;
  for (const row of document.querySelectorAll("#both [data-name]")) {
    const cells = state.numbers?.both?.[row.dataset.name] ?? Array(3).fill(waiting ? ["…", ""] : null);
    row.replaceChildren(row.firstElementChild, ...cells.map((cell) => {
      const made = document.createElement("td"), value = document.createElement("b");
      const [text, interval] = cell ?? ["–", ""];
      value.textContent = text;
      made.append(value, interval);
      return made;
    }));
  }
}

// Both powers of one leg, first that of what drives; and the design it is compared with, as the paper assumes.
function headline(own, compared) {
  const rider = state.numbers ? state.numbers.rider : "…", muscles = state.drive === "muscles";
  const assumed = own && `${own.numbers[0].text} W`, ridden = own && (rider ? `${rider} W` : "not known");
  $("power").textContent = (muscles ? ridden : assumed) ?? "no power";
  const power = own?.power_mean_W, other = compared?.power_mean_W, change = (100 * (power - other)) / Math.abs(other);
  const percent = Number.isFinite(change) && Math.abs(change) >= 0.05 ? `, ${change < 0 ? "−" : "+"}${Math.abs(change).toFixed(1)} %` : "";
  $("against").textContent = [
    own && (muscles ? `for a rider; as the paper assumes ${assumed}` : `as the paper assumes; for a rider ${ridden}`),
    !muscles && Number.isFinite(other) && `${state.reference.name}: ${other.toFixed(2)} W${percent}`,
  ].filter(Boolean).join("; ");
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
  if (state.numbers?.static) {
    const name = `${state.moments} muscles`, { static: y, sd } = state.numbers, colour = start.series[start.moments.indexOf(state.moments) % start.series.length];
    curves.push({ name, y, colour, width: 2.4, dash: "9 3 2 3" });
    if (!state.hidden.has(name)) bands.push({ low: y.map((power, n) => power - sd[n]), high: y.map((power, n) => power + sd[n]), colour });
  }
  const other = reference.turn.moments?.[state.moments];
  if (other) curves.unshift({ name: reference.name, y: other.masses, colour: start.colours.comparison, width: 1.2 });
  const visible = curves.filter((curve) => !state.hidden.has(curve.name));
  powerPlot.show({ curves: visible, bands, levels: [{ y: 0, colour: "none" }], shaded: turn.moments?.[state.moments]?.outside ?? [] });
  entries.power = legend($("power-legend"), curves, "W", state.hidden, redraw);

  const range = turn.moments?.[state.moments]?.range_deg;
  const joints = Object.entries(turn.joints ?? {}).map(([name, y]) => ({ name, y, colour: start.colours[name], width: 2 }));
  const levels = range ? joints.flatMap(({ name, colour }) => range[name].map((y) => ({ y, colour, dash: "2 3" }))) : [];
  jointsPlot.show({ curves: joints.filter((curve) => !state.hidden.has(curve.name)), levels });
  entries.joints = legend($("joints-legend"), joints, "°", state.hidden, redraw, range ? [{ name: "range of the moments", dash: "2 3", colour: "currentColor", width: 1.2 }] : []);
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

const attempt = (action) => async (...event) => {
  tell("");
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
$("limits").addEventListener("change", () => show(false));
$("compared").addEventListener("change", () => refresh());
$("design").addEventListener("change", (event) => load(start.designs[event.target.value]));
$("moments").addEventListener("change", (event) => { state.moments = event.target.value; refresh(); });
$("drive").addEventListener("change", (event) => { state.drive = event.target.value; refresh(); });
$("kind").addEventListener("change", attempt((event) => change({ kind: event.target.value })));
$("branch").addEventListener("change", attempt((event) => change({ branch: event.target.value })));
$("take-rider").addEventListener("click", attempt(async () => {
  if (within($("percentile"))) await change({ percentile: $("percentile").valueAsNumber, sex: $("sex").value });
}));
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

addEventListener("popstate", ({ state: entry }) => {
  if (!entry) return arrive(); // an address that was typed
  Object.assign(state, { design: copy(entry.design), loaded: copy(entry.loaded), touched: null });
  showDesign();
});

play(state.playing);
await arrive();
requestAnimationFrame(frame);
