// The theme's search reads - + : ^ ~ * as operators and joins words by "or". People type --cmd-vel, /cmd_vel, package://.
// Of a word with parts, all parts are required. A plain word is shortened to its stem, and the whole word counts more.
// Five words, or three with seven parts, are a message: its rare words count in every text, not only in titles.
const COMMON_WORDS = new Set(("a all an and are as at be by can do does for from have how i in is it me my no not of on or " +
  "so the there this to too was what when where why will with").split(" "));

function searchQuery(typed) {
  if (typed.includes('"')) return typed;
  const words = typed.toLowerCase().split(/\s+/).map((word) => word.split(/[^\p{L}\p{N}]+/u).filter(Boolean));
  const rare = words.filter((parts) => parts.length > 1 || (parts.length && !COMMON_WORDS.has(parts[0])));
  if (rare.length > 4 || (rare.length > 2 && rare.flat().length > 6)) return rare.flat().flatMap((word) => [`text:${word}^10`, `text:${stem(word)}`]).join(" ");
  return (rare.length ? rare : words).flatMap((parts) => {
    const last = parts[parts.length - 1];
    if (parts.length < 2) return parts.flatMap((word) => [`${word}^10`, `${stem(word)}*`]);
    const whole = parts.slice(0, -1).map((part) => COMMON_WORDS.has(part) ? part : `+${part}`);
    return [...whole, `+${last}*`, `${last}^10`]; // the last part may be unfinished
  }).join(" ");
}

function stem(word) {
  return word.replace(/^(.{4,}?)(?:ing|ed|es|e|s)$/, "$1");
}

if (typeof Worker !== "undefined") {
  globalThis.Worker = class extends Worker {
    postMessage(message, ...more) {
      const isQuery = message && message.type === 2 && typeof message.data === "string";
      super.postMessage(isQuery ? { ...message, data: searchQuery(message.data) } : message, ...more);
    }
  };
}
