// A run, its progress and its verdict, which says so when something else has come into the hand since.

import { ask } from "./server.js";

export class Runs {
  // question: what a run is asked. inHand: what is asked about now, as a text. onDesign: takes the one that a run made.
  constructor(bar, box, question, inHand, onDesign) {
    this.buttons = [...bar.querySelectorAll("[data-run]")];
    this.cancel = bar.querySelector("#cancel");
    Object.assign(this, { box, question, inHand, onDesign });
    this.of = null; // what was in the hand when it was run
    this.earlier = document.createElement("span");
    for (const button of this.buttons) button.addEventListener("click", () => this.run(button));
    this.cancel.addEventListener("click", () => this.stop.abort());
  }

  // To be called when something else may have come into the hand.
  compare() {
    this.earlier.hidden = this.of === this.inHand();
  }

  async run(button) {
    const { box } = this, line = document.createElement("p"), question = this.question();
    if (!question) return;
    const { name } = question.design; // which may change meanwhile
    const say = (text) => (line.textContent = `${button.textContent}, ${name}: ${text}`);
    this.of = this.inHand();
    this.earlier.textContent = `Earlier, of ${name}: `;
    this.stop = new AbortController();
    this.running(true);
    say("running…");
    box.replaceChildren(line);
    try {
      const answer = await ask(button.dataset.run, question, { onProgress: say, signal: this.stop.signal });
      line.className = answer.ok ? "good" : "bad";
      line.replaceChildren(this.earlier, answer.verdict);
      if (answer.design) line.append(" ", this.offer(answer.design));
      if (answer.checks) box.append(table(answer.checks));
    } catch (error) {
      line.className = "bad";
      line.replaceChildren(this.earlier, error.message);
    }
    this.compare();
    this.running(false);
  }

  running(on) {
    for (const button of this.buttons) button.disabled = on;
    this.cancel.hidden = !on;
  }

  offer(design) {
    const button = Object.assign(document.createElement("button"), { type: "button", textContent: "Use this design" });
    button.addEventListener("click", () => {
      button.remove();
      this.onDesign(design);
      this.of = this.inHand();
      this.compare();
    });
    return button;
  }
}

function table(checks) {
  const node = document.createElement("table"), head = node.createTHead().insertRow(), body = node.createTBody();
  for (const text of ["check", "value", "limit", ""]) head.append(Object.assign(document.createElement("th"), { textContent: text, scope: "col" }));
  for (const { name, value, limit, ok } of checks) {
    const row = body.insertRow();
    for (const text of [name, value, limit, ok ? "ok" : "FAILED"]) row.insertCell().textContent = text;
    row.lastChild.className = ok ? "good" : "bad";
  }
  const details = document.createElement("details");
  details.append(Object.assign(document.createElement("summary"), { textContent: `${checks.length} checks` }), node);
  return details;
}
