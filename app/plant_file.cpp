#include "app/plant_file.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/byte_text.h"
#include "app/hand_encoder.h"
#include "app/time_text.h"
#include "systemc/core/input_file.h"
#include "systemc/core/usage_error.h"
#include "systemc/machine/toml_table.h"

namespace brick {

namespace {

using plant::Amplifier;
using plant::AxisParameters;
using plant::Drive;
using plant::EncoderParameters;
using plant::Incident;
using plant::kUnitsPerCount;

const std::vector<std::string> kKeys{"title", "seed", "step", "dac_bits", "axis", "incident"};
const std::vector<std::string> kAxisKeys{"axes",        "drive",     "start",   "load",    "encoder",
                                         "motor",       "amplifier", "stepper", "brake",   "plus_limit",
                                         "minus_limit", "home",      "noise",   "absolute"};
const std::vector<std::string> kEncoderKeys{"lines",       "index_at", "index_width", "wiring",     "halls",
                                            "hall_offset", "b_late",   "a_long",      "dark_lines", "joint_lines"};
const std::vector<std::string> kMotorKeys{"inertia",    "viscous",    "coulomb",   "torque_constant",
                                          "resistance", "inductance", "pole_pairs"};
const std::vector<std::string> kAmplifierKeys{"bus_volts", "full_scale_amps", "trip_amps", "fault_level",
                                              "adc",       "adc_noise",       "always_on"};
const std::vector<std::string> kStepperKeys{"counts_per_step", "move_time", "min_width", "dir_setup"};
const std::vector<std::string> kAbsoluteKeys{"bits",     "turns", "code",    "parity",
                                             "monoflop", "delay", "missing", "error_every"};
const std::vector<std::string> kBrakeKeys{"torque", "opened_by", "delay"};
const std::vector<std::string> kHomeKeys{"from", "to", "level"};
const std::vector<std::string> kNoiseKeys{"every", "shortest", "longest", "pins"};
const std::vector<std::string> kIncidentKeys{"at", "axes", "trip", "cut", "load", "turn", "within"};

constexpr std::int64_t kFarthest = 1'000'000'000'000;  // counts; in units well within 63 bits
constexpr double kHuge = 1e9;
constexpr const char* kAxesText = "a motor, a range or a list in quotes: \"1-8\", \"1,3\"";

// A name in the file and what it stands for.
template <class T>
using Names = std::vector<std::pair<std::string, T>>;

const Names<Drive> kDrives{{"hand", Drive::kHand},
                           {"torque", Drive::kTorque},
                           {"brush", Drive::kBrush},
                           {"three-phase", Drive::kThreePhase},
                           {"stepper", Drive::kStepper}};
const Names<EncoderParameters::Wiring> kWirings{{"none", EncoderParameters::Wiring::kNone},
                                                {"halls", EncoderParameters::Wiring::kHalls},
                                                {"complements", EncoderParameters::Wiring::kComplements},
                                                {"halls-on-abc", EncoderParameters::Wiring::kHallsOnAbc}};
using Parity = plant::SsiEncoderParameters::Parity;
const Names<bool> kCodes{{"binary", false}, {"gray", true}};
const Names<Parity> kParities{{"none", Parity::kNone}, {"odd", Parity::kOdd}, {"even", Parity::kEven}};
const Names<Amplifier::Fault> kCauses{
    {"over-current", Amplifier::Fault::kOverCurrent},         {"shorted-bus", Amplifier::Fault::kShortedBus},
    {"under-voltage", Amplifier::Fault::kUnderVoltage},       {"over-voltage", Amplifier::Fault::kOverVoltage},
    {"over-temperature", Amplifier::Fault::kOverTemperature}, {"i2t", Amplifier::Fault::kI2t}};

template <class T>
T one_of(const TomlTable& table, const std::string& key, const Names<T>& names) {
  const std::string text = table.text(key);
  std::vector<std::string> known;
  for (const auto& [name, value] : names) {
    if (name == text) return value;
    known.push_back(name);
  }
  table.fail(table.need(key), key, fmt::format("one of {}", fmt::join(known, ", ")));
}

// Each reads one value into `to` where the file has it, and leaves it as it is where not.
void read(const TomlTable& t, const std::string& key, double low, double high, const std::string& expected,
          double& to) {
  if (t.has(key)) to = t.real(key, low, high, expected);
}
template <class T>
void read_whole(const TomlTable& t, const std::string& key, std::int64_t low, std::int64_t high, T& to) {
  if (t.has(key)) to = static_cast<T>(t.integer(key, low, high, fmt::format("an integer, {} to {}", low, high)));
}
void read(const TomlTable& t, const std::string& key, bool& to) {
  if (t.has(key)) to = t.flag(key);
}
void read_time(const TomlTable& t, const std::string& key, Tick low, Tick& to) {
  constexpr Tick kLongest = 3600 * kPwmClockHz;
  if (!t.has(key)) return;
  Tick ticks = -1;
  try {
    ticks = fs_to_tick(parse_time(t.text_in(key, t.need(key))));
  } catch (const UsageError&) {}
  if (ticks < low || ticks > kLongest)
    t.fail(t.need(key), key,
           fmt::format("a time in quotes of {} or more and up to an hour, for example \"2us\"",
                       low > 0 ? "a tick (8.5 ns)" : "0"));
  to = ticks;
}
// Counts with a fraction, as units.
void read_counts(const TomlTable& t, const std::string& key, double most, std::int64_t& to) {
  if (!t.has(key)) return;
  const double counts = t.real(key, -most, most, fmt::format("counts, -{} to {}", most, most));
  to = static_cast<std::int64_t>(counts * static_cast<double>(kUnitsPerCount));
}

class Reader {
 public:
  Reader(const std::string& path, std::uint32_t fitted)
      : fitted_(fitted), root_(parse_toml(read_input_file(path, "a plant in TOML"), path)), file_(path, root_, kKeys) {
    while (motor_place(fitted_, motors_ + 1)) ++motors_;
  }

  plant::PlantParameters read_all(std::uint64_t seed) {
    plant::PlantParameters parameters;
    parameters.seed = seed;
    if (file_.has("title")) file_.text("title");
    read_whole(file_, "seed", 0, INT64_MAX, parameters.seed);
    read_time(file_, "step", 1, parameters.step);
    read_whole(file_, "dac_bits", 16, 18, parameters.dac_bits);
    if (parameters.dac_bits == 17) file_.fail(file_.need("dac_bits"), "dac_bits", "16 or 18");
    for (const toml::node& item : file_.array("axis")) read_axes(item, parameters);
    if (parameters.axes.empty()) file_.fail(file_.need("axis"), "axis", "one [[axis]] at least");
    if (file_.has("incident"))
      for (const toml::node& item : file_.array("incident")) read_incident(item, parameters);
    return parameters;
  }

 private:
  // Motors (1, 2, ...) that a table is about: 3, "1-8", "1,3,5-8".
  std::vector<unsigned> motors(const TomlTable& t) const {
    const toml::node& node = t.need("axes");
    if (node.is_integer()) return {one_motor(t, "axes", node, node.value<std::int64_t>().value_or(0))};
    const auto text = node.value_exact<std::string>();
    if (!text) t.fail(node, "axes", kAxesText);
    std::vector<unsigned> list;
    for (std::size_t at = 0; at <= text->size();) {
      const std::size_t end = std::min(text->find(',', at), text->size());
      const std::string part = text->substr(at, end - at);
      const std::size_t dash = part.find('-');
      const unsigned first = one_motor(t, "axes", node, number(t, node, part.substr(0, dash)));
      const unsigned last =
          dash == std::string::npos ? first : one_motor(t, "axes", node, number(t, node, part.substr(dash + 1)));
      if (last < first) t.fail(node, "axes", "the lower motor first");
      for (unsigned motor = first; motor <= last; ++motor) list.push_back(motor);
      at = end + 1;
    }
    return list;
  }
  static std::int64_t number(const TomlTable& t, const toml::node& node, const std::string& digits) {
    if (digits.empty() || digits.size() > 3 || digits.find_first_not_of("0123456789") != std::string::npos)
      t.fail(node, "axes", kAxesText);
    return std::stol(digits);
  }
  unsigned one_motor(const TomlTable& t, const std::string& key, const toml::node& node, std::int64_t motor) const {
    if (motor < 1 || motor > motors_)
      t.fail(node, key,
             motors_ == 0 ? std::string("a board with servo ICs: this one has no motor outputs")
                          : fmt::format("motors 1 to {}: the board has no more", motors_));
    return static_cast<unsigned>(motor);
  }

  void read_axes(const toml::node& item, plant::PlantParameters& parameters) {
    const TomlTable t = file_.table("axis", item, kAxisKeys);
    AxisParameters axis;
    axis.drive = one_of(t, "drive", kDrives);
    read_whole(t, "start", -kFarthest, kFarthest, axis.start);
    read(t, "load", -kHuge, kHuge, "a torque in N m", axis.load);
    if (t.has("motor")) read_motor(t.table("motor", t.need("motor"), kMotorKeys), axis.motor);
    axis.encoder.pole_pairs = axis.motor.pole_pairs;
    if (t.has("encoder")) read_encoder(t.table("encoder", t.need("encoder"), kEncoderKeys), axis.encoder);
    if (t.has("absolute")) read_absolute(t.table("absolute", t.need("absolute"), kAbsoluteKeys), axis);
    axis.amplifier.adc = axis.drive == Drive::kBrush || axis.drive == Drive::kThreePhase;
    if (t.has("amplifier")) read_amplifier(t.table("amplifier", t.need("amplifier"), kAmplifierKeys), axis.amplifier);
    if (t.has("stepper")) read_stepper(t.table("stepper", t.need("stepper"), kStepperKeys), axis.stepper);
    if (t.has("brake")) read_brake(t.table("brake", t.need("brake"), kBrakeKeys), axis.brake);
    read_switches(t, axis);
    if (t.has("noise")) read_noise(t.table("noise", t.need("noise"), kNoiseKeys), axis.noise);
    for (const unsigned motor : motors(t)) {
      if (std::find(taken_.begin(), taken_.end(), motor) != taken_.end())
        t.fail(t.need("axes"), "axes", fmt::format("each motor once: motor {} has an axis already", motor));
      taken_.push_back(motor);
      const MotorPlace place = *motor_place(fitted_, motor);
      axis.ic = place.ic;
      axis.channel = place.channel;
      parameters.axes.push_back(axis);
    }
    try {
      plant::Axis(axis, 0, parameters.step);
    } catch (const std::exception& e) {
      t.fail(t.need("axes"), "axes", fmt::format("an axis that can be: {}", e.what()));
    }
  }

  static void read_motor(const TomlTable& t, plant::MotorParameters& m) {
    read(t, "inertia", 1e-9, kHuge, "kg m2, 1e-9 or more", m.inertia);
    read(t, "viscous", 0, kHuge, "N m s, 0 or more", m.viscous);
    read(t, "coulomb", 0, kHuge, "N m, 0 or more", m.coulomb);
    read(t, "torque_constant", 0, kHuge, "N m / A, 0 or more", m.torque_constant);
    read(t, "resistance", 0, kHuge, "ohms of a winding, 0 or more", m.resistance);
    read(t, "inductance", 1e-9, kHuge, "H of a winding, 1e-9 or more", m.inductance);
    read_whole(t, "pole_pairs", 1, 1000, m.pole_pairs);
  }

  static void read_encoder(const TomlTable& t, EncoderParameters& e) {
    read_whole(t, "lines", 1, 1'000'000, e.lines);
    read_whole(t, "index_at", 0, 4 * std::int64_t{e.lines} - 1, e.index_at);
    read_whole(t, "index_width", 1, 4, e.index_width);
    if (t.has("wiring")) e.wiring = one_of(t, "wiring", kWirings);
    read_whole(t, "halls", 1, 1000, e.pole_pairs);
    read_counts(t, "hall_offset", 4e6, e.hall_offset);
    read_counts(t, "b_late", 0.999, e.b_late);
    read_counts(t, "a_long", 0.999, e.a_long);
    for (const auto& [key, lines] :
         {std::pair{"dark_lines", &e.dark_lines}, std::pair{"joint_lines", &e.joint_lines}}) {
      if (!t.has(key)) continue;
      for (const toml::node& item : t.array(key)) {
        const auto line = item.value_exact<std::int64_t>();
        if (!line || *line < 0 || *line >= e.lines) t.fail(item, key, fmt::format("lines 0 to {}", e.lines - 1));
        lines->push_back(static_cast<unsigned>(*line));
      }
    }
  }

  static void read_absolute(const TomlTable& t, AxisParameters& axis) {
    plant::SsiEncoderParameters& ssi = axis.absolute.emplace();
    ssi.bits = 12;
    read_whole(t, "bits", 1, 32, ssi.bits);
    read_whole(t, "turns", 0, 32 - std::int64_t{ssi.bits}, axis.absolute_turns);
    ssi.bits += axis.absolute_turns;
    if (t.has("code")) ssi.gray = one_of(t, "code", kCodes);
    if (t.has("parity")) ssi.parity = one_of(t, "parity", kParities);
    read_time(t, "monoflop", 1, ssi.monoflop);
    read_time(t, "delay", 0, ssi.delay);
    read(t, "missing", ssi.missing);
    read_whole(t, "error_every", 0, 1'000'000'000, ssi.error_every);
  }

  static void read_amplifier(const TomlTable& t, plant::AmplifierParameters& a) {
    read(t, "bus_volts", 0, kHuge, "volts, 0 or more", a.bus_volts);
    read(t, "full_scale_amps", 1e-3, kHuge, "amperes, 0.001 or more", a.full_scale_amps);
    read(t, "trip_amps", 1e-3, kHuge, "amperes, 0.001 or more", a.trip_amps);
    read(t, "fault_level", a.fault_level);
    read(t, "adc", a.adc);
    read_whole(t, "adc_noise", 0, 8191, a.adc_noise);
    read(t, "always_on", a.always_on);
  }

  static void read_stepper(const TomlTable& t, plant::StepperParameters& s) {
    read_counts(t, "counts_per_step", 1e6, s.units_per_step);
    read_time(t, "move_time", 1, s.move_time);
    read_time(t, "min_width", 0, s.min_width);
    read_time(t, "dir_setup", 0, s.dir_setup);
  }

  void read_brake(const TomlTable& t, plant::BrakeParameters& b) const {
    t.need("torque");
    read(t, "torque", 1e-9, kHuge, "N m, above 0", b.torque);
    read_time(t, "delay", 0, b.delay);
    const MotorPlace place =
        *motor_place(fitted_, one_motor(t, "opened_by", t.need("opened_by"),
                                        t.integer("opened_by", 0, INT64_MAX, "the motor whose AENA opens it")));
    b.ic = place.ic;
    b.channel = place.channel;
  }

  // A limit switch is open, which reads 1, beyond its place (motion:6.2/1).
  static void read_switches(const TomlTable& t, AxisParameters& axis) {
    std::int64_t place = 0;
    if (t.has("plus_limit")) {
      read_whole(t, "plus_limit", -kFarthest, kFarthest, place);
      axis.switches.push_back({kPlim, place, 2 * kFarthest, true});
    }
    if (t.has("minus_limit")) {
      read_whole(t, "minus_limit", -kFarthest, kFarthest, place);
      axis.switches.push_back({kMlim, -2 * kFarthest, place, true});
    }
    if (!t.has("home")) return;
    const TomlTable h = t.table("home", t.need("home"), kHomeKeys);
    plant::Switch home{kHmfl, 0, 0, true};
    const auto counts = [&h](const std::string& key) {
      return h.integer(key, -kFarthest, kFarthest, fmt::format("counts, -{} to {}", kFarthest, kFarthest));
    };
    home.from = counts("from");
    home.to = counts("to");
    if (home.to <= home.from) h.fail(h.need("to"), "to", "a place above `from`");
    read(h, "level", home.level);
    axis.switches.push_back(home);
  }

  static void read_noise(const TomlTable& t, plant::NoiseParameters& n) {
    read_time(t, "every", 2, n.every);
    if (n.every == 0) t.fail(t.need("every"), "every", "the mean time between two disturbances");
    read_time(t, "shortest", 1, n.shortest);
    n.longest = n.shortest;
    read_time(t, "longest", n.shortest, n.longest);
    if (t.has("pins")) n.pins = pins(t, "pins");
  }
  static std::uint16_t pins(const TomlTable& t, const std::string& key) {
    std::uint16_t mask = 0;
    for (const toml::node& item : t.array(key)) {
      const auto found =
          std::find(kChannelPinNames.begin(), kChannelPinNames.end(), item.value_exact<std::string>().value_or(""));
      if (found == kChannelPinNames.end())
        t.fail(item, key, fmt::format("pins in quotes, of {}", fmt::join(kChannelPinNames, ", ")));
      mask = static_cast<std::uint16_t>(mask | 1u << (found - kChannelPinNames.begin()));
    }
    return mask;
  }

  void read_incident(const toml::node& item, plant::PlantParameters& parameters) const {
    const TomlTable t = file_.table("incident", item, kIncidentKeys);
    Incident incident;
    t.need("at");
    read_time(t, "at", 0, incident.at);
    if (t.has("trip")) incident.trip = one_of(t, "trip", kCauses);
    if (t.has("cut")) incident.cut = pins(t, "cut");
    if (t.has("load")) incident.load = t.real("load", -kHuge, kHuge, "a torque in N m");
    read_whole(t, "turn", -kFarthest, kFarthest, incident.turn);
    if (t.has("turn")) t.need("within");
    read_time(t, "within", 1, incident.turn_time);
    if (!incident.trip && !incident.cut && !incident.load && incident.turn == 0)
      t.fail(item, "incident", "one of trip, cut, load, turn");
    for (const unsigned motor : motors(t)) {
      const auto found = std::find(taken_.begin(), taken_.end(), motor);
      if (found == taken_.end())
        t.fail(t.need("axes"), "axes", fmt::format("motors that have an [[axis]]: motor {} has none", motor));
      incident.axis = static_cast<std::size_t>(found - taken_.begin());
      if (incident.turn != 0 && parameters.axes[incident.axis].drive != Drive::kHand)
        t.fail(t.need("turn"), "turn", fmt::format("an axis with drive = \"hand\": motor {} has another", motor));
      parameters.incidents.push_back(incident);
    }
  }

  std::uint32_t fitted_;
  unsigned motors_ = 0;  // of the board
  toml::table root_;
  TomlTable file_;
  std::vector<unsigned> taken_;  // motors with an axis, in the order of PlantParameters::axes
};

}  // namespace

plant::PlantParameters read_plant_file(const std::string& path, std::uint32_t fitted, std::uint64_t seed) {
  return Reader(path, fitted).read_all(seed);
}

Amplifier::Fault amplifier_fault(const std::string& cause) {
  std::vector<std::string> known;
  for (const auto& [name, fault] : kCauses) {
    if (name == cause) return fault;
    known.push_back(name);
  }
  throw UsageError(fmt::format("{} is no cause; expected one of {}", beginning_of(cause), fmt::join(known, ", ")));
}

std::uint16_t channel_pins(const std::vector<std::string>& names) {
  unsigned pins = 0;
  for (const std::string& name : names) {
    const auto* found = std::find(kChannelPinNames.begin(), kChannelPinNames.end(), name);
    if (found == kChannelPinNames.end())
      throw UsageError(fmt::format("{} is no input pin of a channel; expected one of {}", beginning_of(name),
                                   fmt::join(kChannelPinNames, ", ")));
    pins |= 1u << (found - kChannelPinNames.begin());
  }
  return static_cast<std::uint16_t>(pins);
}

}  // namespace brick
