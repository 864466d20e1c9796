// Where the packed words of a servo IC's component have what belongs to the whole IC; the channels' inputs are in words
// 0..3, their outputs in words 0 and 1 as core/motor_pins.h has them.
#pragma once

namespace brick::component::servo_ic_words {

constexpr unsigned kAdcA = 12, kAdcB = 13;  // of a channel's input word, above the pins
constexpr unsigned kControl = 4, kRstN = 0, kTrip = 1, kPhaseIn = 2, kServoIn = 3, kInputWords = 5;
constexpr unsigned kClocks = 2, kPhase = 0, kPhaseOe = 1, kServo = 2, kServoOe = 3, kOutputWords = 3;

}  // namespace brick::component::servo_ic_words
