// Where the packed words of the clock selection's component have its pins: a word for each group of one bit an IC.
#pragma once

namespace brick::component::clock_select_words {

constexpr unsigned kIcs = 22;
constexpr unsigned kPhaseIn = 0, kServoIn = 1, kPhaseOe = 2, kServoOe = 3, kFitted = 4;  // input words
constexpr unsigned kControl = 5, kRstN = 0, kExtClock = 1, kExtPhase = 2, kExtServo = 3;
constexpr unsigned kPhase = 0, kServo = 1, kConflict = 2, kSource = 3;  // of output word 0

}  // namespace brick::component::clock_select_words
