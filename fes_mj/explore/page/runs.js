// A run of the real thing, and its verdict, kept until the design is another.

import { ask } from "./server.js";

export class Runs {
  // question: what a run is asked. snapshot: the design as it is now, as a text.
  constructor(bar, box, question, snapshot) {
    this.buttons = [...bar.querySelectorAll("button")];
    this.box = box;
    this.question = question;
    this.snapshot = snapshot;
    this.of = null; // the snapshot that was run
    for (const button of this.buttons) button.addEventListener("click", () => this.run(button));
  }

  forget() {
    if (!this.box.dataset.running) this.box.replaceChildren();
  }

  async run(button) {
    const { box, buttons } = this, line = document.createElement("p"), question = this.question();
    this.of = this.snapshot();
    buttons.forEach((each) => (each.disabled = true));
    line.textContent = `${button.textContent}: ${question.design.name} is running…`;
    box.dataset.running = true;
    box.replaceChildren(line);
    try {
      const answer = await ask(button.dataset.run, question);
      line.className = answer.ok ? "good" : "bad";
      line.textContent = `${this.of === this.snapshot() ? "" : "Of the design as it was: "}${answer.verdict}`;
      box.append(table(answer.checks));
    } catch (error) {
      line.className = "bad";
      line.textContent = error.message;
    }
    delete box.dataset.running;
    buttons.forEach((each) => (each.disabled = false));
  }
}

function table(checks) {
  const made = document.createElement("table"), head = made.createTHead().insertRow();
  for (const text of ["check", "value", "limit", ""]) head.append(Object.assign(document.createElement("th"), { textContent: text }));
  for (const { name, value, limit, ok } of checks) {
    const row = made.insertRow();
    for (const text of [name, value, limit, ok ? "ok" : "FAILED"]) row.insertCell().textContent = text;
    row.lastChild.className = ok ? "good" : "bad";
  }
  return made;
}
