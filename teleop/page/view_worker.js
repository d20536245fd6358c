// The picture is drawn here, so that the page itself never waits for it: sticks and keys are read on time.

import {Viewer} from "./viewer.js";

let viewer = null;

function tell() {
  const {views, view, frames, seen, marks} = viewer;
  postMessage({views, view, frames, seen, marks, works: Boolean(viewer.gl)});
}

onmessage = ({data: [name, ...values]}) => {
  if (name === "start") {
    viewer = new Viewer(values[0], tell);
    tell();
  } else viewer[name](...values);
};
