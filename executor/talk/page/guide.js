// The guide: five steps, and which one comes now.

import {make, rebuild} from "./make.js";

const STEPS = [
  ["Show", "Press Record, drive the robot with keys, a gamepad or the sticks on the screen, press End."],
  ["Tell", "Say what you did, in your own words."],
  ["Learn", "Keep and learn: it takes seconds."],
  ["Command", "Type what it shall do, below the picture. Enter shows the plan."],
  ["Watch", "Enter again does it. Stop is always there."],
];

/** Number of the step that comes now, from 0. */
export function stepNow({mode, said, learning, knows, talk}) {
  if (mode === "recording") return 0;
  if (mode === "review") return said ? 2 : 1;
  if (learning) return 2;
  if (!knows) return 0;
  return talk?.phase === "moving" || talk?.answer?.kind === "planned" ? 4 : 3;
}

export class Guide {
  constructor(element) {
    this.element = element;
    this.list = make("ol");
    element.append(make("h2", {id: "title-guide"}, "Show, tell, do"), this.list);
    element.hidden = false;
  }

  show(now) {
    rebuild(this.list, now, () => STEPS.map(([name, how], i) => {
      const item = make("li", {data: {state: i < now ? "past" : i === now ? "now" : "next"}}, make("b", {}, name));
      if (i === now) {
        item.setAttribute("aria-current", "step");
        item.append(make("span", {}, how));
      }
      return item;
    }));
    this.element.dataset.step = String(now + 1);
  }
}
