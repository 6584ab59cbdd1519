// Whether the design can be made: layers, and what comes nearest at which crank angle.

export class Making {
  // onAngle: called with the crank angle, degrees, of a pair that was chosen.
  constructor(box, onAngle) {
    this.parts = Object.fromEntries(["verdict", "layers", "gaps", "unknown"].map((part) => [part, box.querySelector(`.${part}`)]));
    this.onAngle = onAngle;
  }

  show(answer) {
    const { ok, verdict, layers = [], gaps = [], unknown = [] } = answer ?? { ok: true, verdict: "…" }, parts = this.parts;
    parts.verdict.textContent = verdict;
    parts.verdict.classList.toggle("bad", !ok);
    const lines = layers.map((links, n) => `Layer ${n + 1}: ${links.join(", ")}.`);
    if (gaps.length) lines.push("Least distances, negative where parts pass beside each other:");
    parts.layers.textContent = lines.join(" ");
    parts.gaps.replaceChildren(...gaps.map((gap) => this.row(gap)));
    parts.unknown.textContent = unknown.length ? `Not known, as the design has no [frame]: ${unknown.join(", ")}.` : "";
  }

  row({ pair, mm, deg }) {
    const row = document.createElement("tr"), button = document.createElement("button");
    Object.assign(button, { type: "button", textContent: `${deg}°` });
    button.setAttribute("aria-label", `Show ${pair} at ${deg} deg`);
    button.addEventListener("click", () => this.onAngle(deg % 360));
    for (const content of [pair, mm, "mm at"]) row.insertCell().textContent = content;
    row.insertCell().append(button);
    return row;
  }
}
