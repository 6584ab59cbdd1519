// Whether the design can be made, asked when it has rested: layers, and what comes nearest at which crank angle.

import { ask } from "./server.js";

const REST = 400; // ms without a change

export class Making {
  // inHand: what is asked about. onAngle: called with the crank angle, degrees, of a pair that was chosen.
  constructor(box, inHand, onAngle) {
    this.parts = Object.fromEntries(["verdict", "layers", "gaps", "unknown"].map((part) => [part, box.querySelector(`.${part}`)]));
    Object.assign(this, { box, inHand, onAngle });
  }

  // To be called when something else may have come into the hand. turns: whether the linkage does.
  ask(turns) {
    clearTimeout(this.waiting);
    const question = this.inHand(), of = JSON.stringify(question);
    this.box.hidden = !turns;
    if (!turns || of === this.of) return;
    this.of = null;
    this.parts.verdict.textContent = "…";
    this.waiting = setTimeout(async () => {
      const answer = await ask("making", question).catch((error) => ({ ok: false, verdict: error.message }));
      if (of !== JSON.stringify(this.inHand())) return;
      this.of = of;
      this.show(answer);
    }, REST);
  }

  show({ ok, verdict, layers = [], gaps = [], unknown = [] }) {
    const parts = this.parts;
    parts.verdict.textContent = verdict;
    parts.verdict.classList.toggle("bad", !ok);
    parts.layers.textContent = layers.map((links, n) => `Layer ${n + 1}: ${links.join(", ")}.`).join(" ");
    parts.gaps.replaceChildren(...gaps.map(({ pair, mm, deg }) => {
      const row = document.createElement("tr"), button = document.createElement("button");
      button.type = "button";
      button.textContent = `${deg}°`;
      button.setAttribute("aria-label", `Show ${pair} at ${deg} deg`);
      button.addEventListener("click", () => this.onAngle(deg % 360));
      for (const content of [pair, mm, "mm at"]) row.insertCell().textContent = content;
      row.insertCell().append(button);
      return row;
    }));
    parts.unknown.textContent = unknown.length ? `Not known, as the design has no [frame]: ${unknown.join(", ")}.` : "";
  }
}
