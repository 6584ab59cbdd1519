// Questions to the server, and the files that it answers with.

const TOKEN = new URLSearchParams(location.search).get("token") ?? "";
// this tab's own name, under which the server keeps the moments that it has opened
const page = (sessionStorage.page ??= [...crypto.getRandomValues(new Uint8Array(12))].join("-"));

// onProgress: told how far a run has come; signal: ends a run.
export async function ask(name, question = {}, { onProgress = () => {}, signal } = {}) {
  const headers = { "Content-Type": "application/json", "X-Token": TOKEN };
  let response, answer;
  try {
    response = await fetch(name, { method: "POST", headers, body: JSON.stringify({ page, ...question }), signal });
    answer = await lastLine(response, onProgress);
  } catch (error) {
    if (signal?.aborted) throw new Error("Cancelled.");
    if (response && !response.ok) throw new Error(`fes_mj explore answered with ${response.status} ${response.statusText}`);
    const there = await fetch("", { method: "HEAD" }).catch(() => null);
    throw new Error(there ? "the answer was lost on its way; ask again" : "fes_mj explore has ended; start it again and open the address that it prints");
  }
  if (answer.error) throw new Error(answer.error);
  return answer;
}

// The answer is the last line; those before it say how far a run has come.
async function lastLine(response, onProgress) {
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  for (let text = ""; ; ) {
    const { done, value } = await reader.read();
    if (done) return JSON.parse(text);
    const lines = (text + value).split("\n");
    text = lines.pop();
    for (const line of lines) onProgress(JSON.parse(line).progress);
  }
}

export function download({ name, text }) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text]));
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}
