import assert from "node:assert/strict";
import { test } from "node:test";
import { inspect } from "node:util";

import { axisJog, distance, move, segment, speed } from "#internal/requests.js";
import { Distance, mm, pulses, um } from "axisgate";
import { AxisJog_Direction, Rounding, Unit } from "axisgate/v1";

test("text and bigint are exact", () => {
  assert.deepEqual(distance(mm("1.5")).amount, { case: "mm", value: "1.5" });
  assert.deepEqual(distance(um(-2n)).amount, { case: "um", value: "-2" });
  assert.deepEqual(distance(pulses("+7")).amount, { case: "pulses", value: 7n });
  assert.deepEqual(distance(pulses(2n ** 62n)).amount, { case: "pulses", value: 2n ** 62n });
  assert.deepEqual(speed(mm("2").perSecond).amount, { case: "mmPerS", value: "2" });
});

test("a number is rounded to the nearest pulse", () => {
  const { amount } = distance(mm(0.1 + 0.2));
  assert.ok(amount.case === "floating");
  const { value, unit, rounding } = amount.value;
  assert.deepEqual([value, unit, rounding], [0.1 + 0.2, Unit.MILLIMETERS, Rounding.NEAREST]);
});

test("what is no amount is refused", () => {
  for (const amount of [NaN, Infinity, "", "1,5", "0x10", "1 mm"]) assert.throws(() => mm(amount), RangeError);
  assert.throws(() => distance(pulses("1.5")), RangeError);
  // @ts-expect-error An object is no amount.
  assert.throws(() => mm({}), TypeError);
});

test("a bare number and an amount of the wrong kind do not compile, and are refused", () => {
  // @ts-expect-error A bare number is no distance.
  assert.throws(() => distance(1.5), TypeError);
  // @ts-expect-error A bare number is no target.
  assert.throws(() => move("devices/stage", { x: 1.5 }, {}), /write an amount with its unit/);
  // @ts-expect-error A bare number is no speed.
  assert.throws(() => move("devices/stage", { x: mm(1) }, { speed: 0 }), TypeError);
  // @ts-expect-error A distance is no speed.
  assert.throws(() => move("devices/stage", { x: mm(1) }, { speed: mm(1) }), /write a distance in each second/);
  // @ts-expect-error A speed is no distance.
  // eslint-disable-next-line @typescript-eslint/no-unsafe-class-instance-assignment
  assert.throws(() => distance(mm(1).perSecond), TypeError);
  assert.throws(() => move("devices/stage", {}, {}), TypeError);
});

test("a point has as many distances as there are axes", () => {
  assert.equal(segment(["x"], mm("1"), undefined).shape.case, "single");
  assert.equal(segment(["x", "y"], [mm("1"), mm("2")], mm("1").perSecond).shape.case, "line");
  assert.throws(() => segment(["x", "y"], [mm("1")], undefined), RangeError);
});

test("a negative speed is a jog in the minus direction", () => {
  for (const amount of ["-2", -2, -2n]) {
    const jog = axisJog("x", mm(amount).perSecond);
    assert.equal(jog.direction, AxisJog_Direction.MINUS);
    const { amount: at } = jog.speed ?? {};
    assert.equal(Number(at?.case === "floating" ? at.value.value : at?.value), 2);
  }
  assert.equal(axisJog("x", pulses(-3n).perSecond).speed?.amount.value, 3n);
  assert.equal(axisJog("x", mm(2).perSecond).direction, AxisJog_Direction.PLUS);
});

test("amounts are shown with their units", () => {
  assert.equal(inspect([new Distance(1.5, "mm"), um("-2").perSecond]), "[ 1.5 mm, -2 um/s ]");
});
