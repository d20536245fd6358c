// Rings in the picture around what a command speaks of, and where it would go.

import {make} from "./make.js";

const LEAST_RADIUS = 14;
const GAP = 6;

/** Where a label may stand at a ring, the best side first: left and top of its box, from the ring's middle. */
const SIDES = {
  below: (radius, width) => [-width / 2, radius + GAP],
  above: (radius, width, height) => [-width / 2, -radius - GAP - height],
  left: (radius, width, height) => [-radius - GAP - width, -height / 2],
  right: (radius, width, height) => [radius + GAP, -height / 2],
};

export class Overlay {
  constructor(element, stage) {
    this.element = element;
    this.stage = stage;
    this.key = "";
    this.made = [];
  }

  show(marks) {
    const key = JSON.stringify(marks);
    if (key === this.key) return;
    this.key = key;
    this.made = marks.map(({role, label}) => {
      const text = make("span", {}, label);
      return {role, text, ring: make("div", {className: "mark", data: {role}, hidden: true}, text)};
    });
    this.element.replaceChildren(...this.made.map(({ring}) => ring));
    this.stage.call("setMarks", marks.map(({position, radius}) => ({position, radius})));
  }

  /** Take where the marks are in the picture that is seen now; labels keep clear of rings and of one another. */
  place(places) {
    if (places.length !== this.made.length) return;
    const rings = places.map(({x, y, radius}) => ({x, y, radius: Math.max(LEAST_RADIUS, 1.5 * radius)}));
    const taken = rings.map(({x, y, radius}) => [x - radius, y - radius, x + radius, y + radius]);
    this.made.forEach(({role, text, ring}, i) => {
      const {x, y, radius} = rings[i];
      Object.assign(ring.style, {left: `${x}px`, top: `${y}px`, width: `${2 * radius}px`, height: `${2 * radius}px`});
      ring.hidden = !places[i].seen;
      if (ring.hidden) return;
      const [width, height] = [text.offsetWidth, text.offsetHeight];
      const boxes = Object.entries(SIDES).map(([side, at]) => {
        const [left, top] = at(radius, width, height);
        return {left, top, box: [x + left, y + top, x + left + width, y + top + height],
          liked: side === (role === "goal" ? "above" : "below")};
      }).sort((a, b) => b.liked - a.liked);
      const inside = [0, 0, this.element.clientWidth, this.element.clientHeight];
      const free = boxes.find(({box}) => within(box, inside) && !taken.some((other, j) => j !== i && meet(box, other)));
      const {left, top, box} = free ?? boxes[0];
      taken.push(box);
      Object.assign(text.style, {left: `${radius + left - 3}px`, top: `${radius + top - 3}px`}); // 3: the ring's border
    });
  }
}

function meet([left, top, right, bottom], other) {
  return left < other[2] && other[0] < right && top < other[3] && other[1] < bottom;
}

function within([left, top, right, bottom], outer) {
  return left >= outer[0] && top >= outer[1] && right <= outer[2] && bottom <= outer[3];
}
