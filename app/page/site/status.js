"use strict";
// Bits of the status words, by their names (firmware:5.2 to firmware:5.8): highest bit, lowest bit, name, and
// for a number of several bits what it says.
const AXES = ["none", "A", "B", "C", "U, V or W", "by inverse kinematics", "6", "X, Y or Z"];
const axisBits = () => ["Z", "Y", "X", "W", "V", "U", "C", "B", "A"].flatMap((axis, i) => [
  [23 - 2 * i, 23 - 2 * i, axis + " is a feedrate axis"], [22 - 2 * i, 22 - 2 * i, axis + " is incremental"]]);
const MODES = {0: "LINEAR", 2: "RAPID", 1: "CIRCLE1", 3: "CIRCLE2", 17: "SPLINE", 18: "PVT"};
const STATUS = {
  motor: [
    [[23, 23, "activated"], [22, 22, "in the negative limit"], [21, 21, "in the positive limit"],
     [20, 20, "extended servo algorithm"], [19, 19, "amplifier enabled"], [18, 18, "open loop"],
     [17, 17, "move of known length"], [16, 16, "integration at rest only"], [15, 15, "dwell"],
     [14, 14, "next move was late"], [13, 13, "desired velocity zero"], [12, 12, "abort decelerates"],
     [10, 10, "searches a trigger"], [9, 9, "user phase"], [8, 8, "user servo"], [7, 7, "alternate source"],
     [6, 6, "phased motor"], [5, 5, "following offset mode"], [4, 4, "position following"], [3, 3, "error trigger"],
     [2, 2, "software capture"], [1, 1, "integrator in the velocity loop"], [0, 0, "alternate output"]],
    [[23, 20, "coordinate system", n => n + 1], [19, 16, "axis", n => AXES[n] || n],
     [15, 15, "assigned to a coordinate system"], [14, 14, "amplifier enabled"],
     [13, 13, "in position by the servo task"], [12, 12, "stopped at its desired position limit"],
     [11, 11, "stopped on a limit"], [10, 10, "home complete"], [9, 9, "phase reference searched"],
     [8, 8, "phase reference missing"], [7, 7, "trigger not found yet"], [6, 6, "integrated following error"],
     [5, 5, "overload (I2T)"], [4, 4, "backlash taken up downwards"], [3, 3, "amplifier fault"],
     [2, 2, "fatal following error"], [1, 1, "warning following error"], [0, 0, "in position"]]],
  system: [
    [...axisBits(), [5, 5, "arc vector incremental"], [4, 4, "continuous motion"], [3, 3, "moves by time"],
     [2, 2, "blended"], [1, 1, "single step"], [0, 0, "program runs"]],
    [[23, 23, "in lookahead"], [22, 22, "run-time error"], [20, 20, "amplifier fault"],
     [19, 19, "fatal following error"], [18, 18, "warning following error"], [17, 17, "in position"],
     [16, 16, "Rotary Buffer Full"], [14, 14, "stop at the end of the block"], [12, 12, "dwell"],
     [7, 7, "made of segments"], [4, 0, "mode", n => MODES[n & 19] || n]],
    [[23, 23, "oldest segments written over"], [22, 22, "goes backwards"], [21, 21, "at the oldest segment"],
     [20, 20, "assignments wait"], [19, 19, "an assignment was lost"], [11, 8, "Isx21"],
     [6, 6, "stop at a sharp corner"], [5, 5, "pause at a sharp corner"], [3, 3, "radius error"],
     [2, 2, "resume refused"], [1, 1, "desired position limit"], [0, 0, "position matching"]]],
  global: [
    [[22, 22, "real-time task re-entered"], [20, 20, "servo task not done in time"], [19, 19, "data gathered"],
     [14, 14, "compensation tables on"], [10, 10, "saved data damaged"], [9, 9, "real-time task late"],
     [7, 7, "other ICs than saved"], [3, 3, "no phase clock"]],
    [[23, 23, "Ultralite"], [20, 20, "binary rotary buffers open"], [19, 19, "motion buffer open"],
     [18, 18, "rotary buffers open"], [17, 17, "PLC buffer open"], [16, 16, "UMAC"], [15, 15, "forward program open"],
     [14, 14, "inverse program open"], [11, 11, "Fixed Buffer Full"]]],
};
const bit = (word, number) => (word >> number & 1) === 1;
