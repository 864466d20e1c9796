#include "testbench/unit/component/servo_ic_block.h"

#include <algorithm>

namespace brick::component {

ServoIcBlock::ServoIcBlock(const char* name) : ic_(name) {
  ic_.reset(0);
  ic_.set_motor_inputs(pins_);
}

void ServoIcBlock::set(const std::string& pin, std::uint32_t value) {
  const auto put = [value](auto& word, unsigned bit) {
    word = static_cast<std::remove_reference_t<decltype(word)>>((word & ~(1u << bit)) | value << bit);
  };
  if (pin == "rst_n") reset_ = value == 0;
  if (reset_) ic_.reset(now_);  // without an edge
  if (pin == "trip") ic_.set_trip(value != 0);
  if (pin == "phase_i") phase_ = value != 0;
  if (pin == "servo_i") servo_ = value != 0;
  ic_.set_pins(phase_, servo_);
  if (pin.rfind("ch", 0) == 0) {
    const auto channel = static_cast<unsigned>(pin[2] - '1');
    const std::string name = pin.substr(4);
    if (name == "adc_a") put(pins_.adc_a, channel);
    if (name == "adc_b") put(pins_.adc_b, channel);
    const auto* place = std::find(kChannelPinNames.begin(), kChannelPinNames.end(), name);
    if (place != kChannelPinNames.end())
      put(pins_.pins[channel], static_cast<unsigned>(place - kChannelPinNames.begin()));
    ic_.set_motor_inputs(pins_);
  }
}

void ServoIcBlock::edge(Tick t) {
  now_ = t;
  if (reset_)
    ic_.reset(t);
  else
    ic_.advance(t);
}

bool ServoIcBlock::moved() {
  const MotorOutputs motor = ic_.motor_outputs();
  const unsigned clocks = ic_.phase() | ic_.servo() << 1 | ic_.phase_oe() << 2 | ic_.servo_oe() << 3;
  const bool moved = motor != shown_ || clocks != clocks_;
  shown_ = motor;
  clocks_ = clocks;
  return moved;
}

std::uint32_t ServoIcBlock::read(unsigned address) { return ic_.read((address & 4) != 0, address / 8); }

void ServoIcBlock::accessed(const Access& access) {
  if (reset_) return;
  if (access.write)
    ic_.write((access.address & 4) != 0, access.address / 8, access.value & 0xFFFFFF);
  else
    ic_.read_taken((access.address & 4) != 0, access.address / 8);
}

std::map<std::string, std::uint32_t> ServoIcBlock::outputs() const {
  std::map<std::string, std::uint32_t> out;
  const MotorOutputs motor = ic_.motor_outputs();
  for (const MotorField& field : motor_pin::kAll) {
    if (field.width != 1) continue;  // the counters are no pins
    for (unsigned n = 0; n < (field.shared ? 1 : kChannels); ++n)
      out[(field.shared ? "" : "ch" + std::to_string(n + 1) + "_") + std::string(field.name)] = motor.get(field, n);
  }
  out["phase_o"] = ic_.phase() || !ic_.phase_oe();
  out["servo_o"] = ic_.servo() || !ic_.servo_oe();
  out["phase_oe"] = ic_.phase_oe();
  out["servo_oe"] = ic_.servo_oe();
  return out;
}

namespace {

class Random {
 public:
  explicit Random(std::uint32_t seed) : random_(seed) {}
  std::uint32_t below(std::uint32_t n) { return random_() % n; }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

 private:
  std::mt19937 random_;
};

// Short clocks, so that all pins move often; every register now and then.
Access servo_ic_access(Random& random) {
  const auto at = [](bool x, unsigned offset) { return 8 * offset + (x ? 4u : 0u); };
  Access a{random.one_in(6) ? random.below(40'000) : 20'000 + random.below(3'000'000), !random.one_in(3), 0, 0};
  if (random.one_in(5)) a.idle = edge_time(random.below(200)) - random.below(2);  // beside an edge
  switch (a.write ? random.below(6) : 5) {
    case 0:
      a.address = at(true, 28);
      a.value = (random.one_in(3) ? random.below(300) : 20 + random.below(40)) << 8 | random.below(8);
      break;
    case 1:
      a.address = at(true, 4);
      a.value = random.below(3) << 20 | random.below(3) << 16 | random.below(4) << 12 | random.below(1u << 12);
      break;
    case 2:  // channel control: EQU, AENA, decode
      a.address = at(true, 8 * random.below(4) + 5);
      a.value = random.below(1u << 24);
      break;
    case 3:  // output words
      a.address = at(false, 8 * random.below(4) + 2 + random.below(3));
      a.value = random.below(1u << 24);
      break;
    default:
      a.address = at(random.one_in(2), random.below(32));
      a.value = random.below(1u << 24);
      break;
  }
  return a;
}

}  // namespace

Traffic servo_ic_traffic(std::uint32_t seed, Tick ticks) {
  Traffic traffic;
  traffic.end = edge_time(ticks);
  Random random(seed);
  std::map<std::string, std::uint32_t> level{{"rst_n", 1}, {"phase_i", 1}, {"servo_i", 1}};
  const MotorInputs idle;
  for (unsigned n = 0; n < kChannels; ++n)
    for (unsigned pin = 0; pin < kChannelPins; ++pin)
      level["ch" + std::to_string(n + 1) + "_" + std::string(kChannelPinNames[pin])] = idle.pins[n] >> pin & 1;
  const auto turn = [&](Picoseconds time, const std::string& pin) {
    traffic.pins.push_back({time, pin, level[pin] ^= 1});
  };
  for (Picoseconds now = 0; now < traffic.end;) {
    now += random.one_in(8) ? random.below(3) : 1000 + random.below(800'000);
    if (random.one_in(4)) now = edge_time(edge_after(now)) - random.below(2);  // in the instant of an edge, or before
    const std::string channel = "ch" + std::to_string(1 + random.below(4)) + "_";
    switch (random.below(12)) {
      case 0:
        turn(now, random.one_in(2) ? "phase_i" : "servo_i");
        break;
      case 1:
        turn(now, channel + std::string(kChannelPinNames[random.below(kChannelPins)]));
        break;
      case 2:
        turn(now, channel + (random.one_in(2) ? "adc_a" : "adc_b"));
        break;
      case 3:
        if (random.one_in(30)) turn(now, "trip");
        if (random.one_in(60)) {
          turn(now, "rst_n");
          now += 1 + random.below(60'000);
          turn(now, "rst_n");
        }
        break;
      default:
        turn(now, channel + (random.one_in(2) ? "enc_a" : "enc_b"));
        break;
    }
  }
  std::stable_sort(traffic.pins.begin(), traffic.pins.end(),
                   [](const PinChange& a, const PinChange& b) { return a.time < b.time; });
  for (Picoseconds now = 0; now < traffic.end; now += traffic.accesses.back().idle + 3 * 8'500)
    traffic.accesses.push_back(servo_ic_access(random));
  return traffic;
}

}  // namespace brick::component
