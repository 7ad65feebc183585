// What goes wrong in the page itself: its reader sees it, not the console alone.

/** Calls `tell(words)` for every error that nothing else handled. */
export function faults(tell) {
  const say = (error) => tell(`Something in this page failed (${error?.message ?? error}): what you see may be incomplete.`);
  // What browsers report without an error, such as a loop of resizing, is not one.
  addEventListener("error", ({ error }) => error && say(error));
  addEventListener("unhandledrejection", ({ reason }) => say(reason));
}
