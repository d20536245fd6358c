// Where a place in the scene is in the picture.

/**
 * @param {{position: number[], radius: number}} thing  centre and half of the width in the world [m]
 * @param {Float32Array} clip  world to clip space, row by row
 * @param {number[]} right  the picture's axis to the right, in the world
 * @returns {{x: number, y: number, radius: number, seen: boolean}} CSS pixels from the upper left corner
 */
export function placed({position, radius}, clip, right, width, height) {
  const [x, y, depth] = pixel(position, clip, width, height);
  const [side] = pixel(position.map((value, i) => value + radius * right[i]), clip, width, height);
  const inside = depth > 0 && x >= 0 && x <= width && y >= 0 && y <= height;
  return {x: round(x), y: round(y), radius: round(Math.abs(side - x)), seen: inside};
}

function pixel([x, y, z], clip, width, height) {
  const row = (i) => clip[4 * i] * x + clip[4 * i + 1] * y + clip[4 * i + 2] * z + clip[4 * i + 3];
  const depth = row(3);
  return [(width * (1 + row(0) / depth)) / 2, (height * (1 - row(1) / depth)) / 2, depth];
}

function round(value) {
  return Math.round(2 * value) / 2;
}
