// A clock in a worker: it goes on evenly while the page draws, which requestAnimationFrame would not.
setInterval(() => postMessage(0), 8);
