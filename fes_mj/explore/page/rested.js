// A question that is asked when the design has rested, and whose answer counts only while it is still the one in hand.

import { ask } from "./server.js";

export const REST = 400; // ms without a change

export class Rested {
  // onAnswer: called with the answer; with null while there is none yet.
  constructor(name, onAnswer) {
    Object.assign(this, { name, onAnswer });
  }

  // question: what is in the hand now; null if there is nothing to ask.
  ask(question) {
    const of = JSON.stringify(question);
    if (of === this.of) return;
    this.of = of;
    clearTimeout(this.waiting);
    this.onAnswer(null);
    if (!question) return;
    this.waiting = setTimeout(async () => {
      const answer = await ask(this.name, JSON.parse(of)).catch((error) => ({ ok: false, verdict: error.message, why: error.message }));
      if (of === this.of) this.onAnswer(answer);
    }, REST);
  }
}
