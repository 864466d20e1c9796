// Plants as people write them: what each key becomes, and every way of getting one wrong.
#include "app/plant_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "systemc/core/usage_error.h"

namespace brick {
namespace {

constexpr std::uint32_t kTwoIcs = 3, kOneIc = 1;

class TemporaryPlant {
 public:
  explicit TemporaryPlant(const std::string& text)
      : path_(std::filesystem::path(::testing::TempDir()) / ("plant_" + std::to_string(::getpid()) + ".toml")) {
    std::ofstream(path_) << text;
  }
  ~TemporaryPlant() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

plant::PlantParameters plant_of(const std::string& text, std::uint32_t fitted = kTwoIcs) {
  return read_plant_file(TemporaryPlant(text).path(), fitted, 7);
}

// What is behind the name of the file.
std::string error_of(const std::string& text, std::uint32_t fitted = kTwoIcs) {
  const TemporaryPlant file(text);
  try {
    read_plant_file(file.path(), fitted, 7);
  } catch (const UsageError& e) {
    const std::string what = e.what();
    return what.rfind(file.path(), 0) == 0 ? what.substr(file.path().size()) : what;
  }
  return "no error";
}

TEST(PlantFile, OneTableForEightAxes) {
  const auto plant = plant_of("[[axis]]\naxes = \"1-8\"\ndrive = \"torque\"\n");
  ASSERT_EQ(plant.axes.size(), 8u);
  EXPECT_EQ(plant.seed, 7u);
  for (unsigned i = 0; i < 8; ++i) {
    EXPECT_EQ(plant.axes[i].ic, i / 4);
    EXPECT_EQ(plant.axes[i].channel, i % 4);
    EXPECT_EQ(plant.axes[i].drive, plant::Drive::kTorque);
    EXPECT_FALSE(plant.axes[i].amplifier.adc);  // a torque amplifier shows no current
  }
}

TEST(PlantFile, MotorsAreCountedThroughTheIcsThatAreFitted) {
  const auto plant = plant_of("[[axis]]\naxes = \"5,2\"\ndrive = \"hand\"\n", 1u << 0 | 1u << 12);
  ASSERT_EQ(plant.axes.size(), 2u);
  EXPECT_EQ(plant.axes[0].ic, 12u);
  EXPECT_EQ(plant.axes[0].channel, 0u);
  EXPECT_EQ(plant.axes[1].ic, 0u);
  EXPECT_EQ(plant.axes[1].channel, 1u);
}

TEST(PlantFile, EveryKeyArrives) {
  const auto plant = plant_of(R"(
title = "T"
seed = 12
dac_bits = 16
[[axis]]
axes = 3
drive = "three-phase"
start = -17
load = 0.25
plus_limit = 1000
minus_limit = -500
home = { from = 100, to = 120, level = false }
[axis.motor]
inertia = 2e-5
viscous = 1e-4
coulomb = 0.01
torque_constant = 0.2
resistance = 3
inductance = 0.004
pole_pairs = 5
[axis.amplifier]
bus_volts = 60
full_scale_amps = 12.5
trip_amps = 18
fault_level = false
adc = false
adc_noise = 2
always_on = true
[axis.stepper]
counts_per_step = 2.5
move_time = "2us"
min_width = "1us"
dir_setup = "0.5us"
[axis.brake]
torque = 0.75
opened_by = 6
delay = "20ms"
[axis.encoder]
lines = 500
index_at = 10
index_width = 4
wiring = "halls"
halls = 6
hall_offset = -12.5
b_late = 0.25
a_long = -0.25
dark_lines = [3]
joint_lines = [7, 499]
[axis.absolute]
bits = 13
turns = 12
code = "gray"
parity = "even"
monoflop = "25us"
delay = "0.5us"
missing = true
error_every = 9
[axis.noise]
every = "1ms"
shortest = "20ns"
longest = "1us"
pins = ["enc_b", "hmfl"]
[[incident]]
at = "2ms"
axes = 3
trip = "over-temperature"
[[incident]]
at = "1ms"
axes = "3"
cut = ["enc_a"]
load = 1
)");
  EXPECT_EQ(plant.seed, 12u);
  EXPECT_EQ(plant.dac_bits, 16u);
  ASSERT_EQ(plant.axes.size(), 1u);
  const plant::AxisParameters& a = plant.axes[0];
  EXPECT_EQ(a.drive, plant::Drive::kThreePhase);
  EXPECT_EQ(a.channel, 2u);
  EXPECT_EQ(a.start, -17);
  EXPECT_EQ(a.load, 0.25);
  EXPECT_EQ(a.brake.torque, 0.75);
  EXPECT_EQ(a.brake.ic, 1u);
  EXPECT_EQ(a.brake.channel, 1u);
  EXPECT_EQ(a.brake.delay, Tick{117'964'800} / 50);
  EXPECT_EQ(a.motor.inertia, 2e-5);
  EXPECT_EQ(a.motor.viscous, 1e-4);
  EXPECT_EQ(a.motor.coulomb, 0.01);
  EXPECT_EQ(a.motor.torque_constant, 0.2);
  EXPECT_EQ(a.motor.resistance, 3);
  EXPECT_EQ(a.motor.inductance, 0.004);
  EXPECT_EQ(a.motor.pole_pairs, 5u);
  EXPECT_EQ(a.amplifier.bus_volts, 60);
  EXPECT_EQ(a.amplifier.full_scale_amps, 12.5);
  EXPECT_EQ(a.amplifier.trip_amps, 18);
  EXPECT_FALSE(a.amplifier.fault_level);
  EXPECT_FALSE(a.amplifier.adc);
  EXPECT_EQ(a.amplifier.adc_noise, 2);
  EXPECT_TRUE(a.amplifier.always_on);
  EXPECT_EQ(a.stepper.units_per_step, 65536 * 5 / 2);
  EXPECT_EQ(a.stepper.move_time, 236);  // 2 us x 117.9648 MHz, the tick that is not before
  EXPECT_EQ(a.stepper.min_width, 118);
  EXPECT_EQ(a.stepper.dir_setup, 59);
  EXPECT_EQ(a.encoder.lines, 500u);
  EXPECT_EQ(a.encoder.index_at, 10u);
  EXPECT_EQ(a.encoder.index_width, 4u);
  EXPECT_EQ(a.encoder.wiring, plant::EncoderParameters::Wiring::kHalls);
  EXPECT_EQ(a.encoder.pole_pairs, 6u);
  EXPECT_EQ(a.encoder.hall_offset, -65536 * 25 / 2);
  EXPECT_EQ(a.encoder.b_late, 16384);
  EXPECT_EQ(a.encoder.a_long, -16384);
  EXPECT_EQ(a.encoder.dark_lines, std::vector<unsigned>{3});
  EXPECT_EQ(a.encoder.joint_lines, (std::vector<unsigned>{7, 499}));
  ASSERT_TRUE(a.absolute);
  EXPECT_EQ(a.absolute->bits, 25u);
  EXPECT_EQ(a.absolute_turns, 12u);
  EXPECT_TRUE(a.absolute->gray);
  EXPECT_EQ(a.absolute->parity, plant::SsiEncoderParameters::Parity::kEven);
  EXPECT_EQ(a.absolute->monoflop, 2950);  // 2949.12
  EXPECT_EQ(a.absolute->delay, 59);
  EXPECT_TRUE(a.absolute->missing);
  EXPECT_EQ(a.absolute->error_every, 9u);
  EXPECT_EQ(a.noise.every, 117'965);
  EXPECT_EQ(a.noise.shortest, 3);
  EXPECT_EQ(a.noise.longest, 118);
  EXPECT_EQ(a.noise.pins, 1u << kEncB | 1u << kHmfl);
  ASSERT_EQ(a.switches.size(), 3u);
  const plant::Switches switches(a.switches);
  const auto pins_at = [&](std::int64_t counts) { return switches.pins(counts * plant::kUnitsPerCount); };
  EXPECT_EQ(pins_at(0), 1u << kHmfl);  // the home switch is low between 100 and 120
  EXPECT_EQ(pins_at(119), 0u);
  EXPECT_EQ(pins_at(999), 1u << kHmfl);
  EXPECT_EQ(pins_at(1000), 1u << kHmfl | 1u << kPlim);
  EXPECT_EQ(pins_at(-500), 1u << kHmfl);
  EXPECT_EQ(pins_at(-501), 1u << kHmfl | 1u << kMlim);
  ASSERT_EQ(plant.incidents.size(), 2u);
  EXPECT_EQ(plant.incidents[0].at, 235'930);
  EXPECT_EQ(plant.incidents[0].trip, plant::Amplifier::Fault::kOverTemperature);
  EXPECT_FALSE(plant.incidents[0].cut);
  EXPECT_EQ(plant.incidents[1].cut, 1u << kEncA);
  EXPECT_EQ(plant.incidents[1].load, 1.0);
}

TEST(PlantFile, PlantsOfTheTree) {
  for (const auto& [name, drive] :
       {std::pair{"dac8", plant::Drive::kTorque}, std::pair{"servo8", plant::Drive::kThreePhase},
        std::pair{"stepper8", plant::Drive::kStepper}}) {
    const auto plant = read_plant_file(std::string(BRICK_SOURCE_DIR "/examples/plants/") + name + ".toml", kTwoIcs, 1);
    EXPECT_EQ(plant.axes.size(), 8u) << name;
    for (const auto& axis : plant.axes) {
      EXPECT_EQ(axis.drive, drive) << name;
      EXPECT_EQ(axis.amplifier.adc, drive == plant::Drive::kThreePhase) << name;
    }
  }
}

// A good axis with more lines behind it.
std::string axis_with(const std::string& lines) { return "[[axis]]\naxes = \"1-2\"\ndrive = \"hand\"\n" + lines; }

// Currents can be read where the drive is one whose loops the controller closes; noise is as long as its shortest.
TEST(PlantFile, DefaultsThatOtherKeysMake) {
  for (const auto& [drive, adc] :
       {std::pair{"torque", false}, {"stepper", false}, {"hand", false}, {"brush", true}, {"three-phase", true}}) {
    const auto plant = plant_of(std::string("[[axis]]\naxes = 1\ndrive = \"") + drive + "\"\n");
    EXPECT_EQ(plant.axes.at(0).amplifier.adc, adc) << drive;
  }
  const auto plant = plant_of(
      "[[axis]]\naxes = 1\ndrive = \"hand\"\nnoise = { every = \"1ms\", shortest = \"40us\", pins = [\"enc_a\"] }\n");
  EXPECT_EQ(plant.axes.at(0).noise.longest, plant.axes.at(0).noise.shortest);
  EXPECT_GT(plant.axes.at(0).noise.longest, 4000);
}

// Each of an incident's motors by its place among the axes, in the order of the file.
TEST(PlantFile, IncidentsFindTheirAxes) {
  const auto plant = plant_of(
      "[[axis]]\naxes = \"5,2\"\ndrive = \"torque\"\n[[axis]]\naxes = 1\ndrive = \"torque\"\n"
      "[[incident]]\nat = \"1ms\"\naxes = \"1-2\"\nload = 1\n");
  ASSERT_EQ(plant.incidents.size(), 2u);
  EXPECT_EQ(plant.incidents[0].axis, 2u) << "motor 1 is the third axis";
  EXPECT_EQ(plant.incidents[1].axis, 1u) << "motor 2";
}

TEST(PlantFile, EveryMistakeHasItsLine) {
  EXPECT_EQ(error_of("title = \"T\"\n"), ": key axis is missing; expected axis = ...");
  EXPECT_EQ(error_of("axis = []\n"), ":1: axis: found []; expected one [[axis]] at least");
  EXPECT_EQ(error_of("[[axis]]\nfoo = 1\n").substr(0, 36), ":2: unknown key foo; expected axes, ");
  EXPECT_EQ(error_of("\n[[axis]]\naxes = 1\n"), ":2: key drive is missing; expected drive = ...");
  EXPECT_EQ(error_of("[[axis]]\naxes = 1\ndrive = \"turbo\"\n"),
            ":3: drive: found \"turbo\"; expected one of hand, torque, brush, three-phase, stepper");
  const std::string list = "; expected a motor, a range or a list in quotes: \"1-8\", \"1,3\"";
  EXPECT_EQ(error_of("[[axis]]\naxes = \"\"\ndrive = \"hand\"\n"), ":2: axes: found \"\"" + list);
  EXPECT_EQ(error_of("[[axis]]\naxes = \"1-\"\ndrive = \"hand\"\n"), ":2: axes: found \"1-\"" + list);
  EXPECT_EQ(error_of("[[axis]]\naxes = \"1,,2\"\ndrive = \"hand\"\n"), ":2: axes: found \"1,,2\"" + list);
  EXPECT_EQ(error_of("[[axis]]\naxes = [1]\ndrive = \"hand\"\n"), ":2: axes: found [ 1 ]" + list);
  EXPECT_EQ(error_of("[[axis]]\naxes = \"3-1\"\ndrive = \"hand\"\n"),
            ":2: axes: found \"3-1\"; expected the lower motor first");
  EXPECT_EQ(error_of("[[axis]]\naxes = \"1-8\"\ndrive = \"hand\"\n", kOneIc),
            ":2: axes: found \"1-8\"; expected motors 1 to 4: the board has no more");
  EXPECT_EQ(error_of("[[axis]]\naxes = 0\ndrive = \"hand\"\n"),
            ":2: axes: found 0; expected motors 1 to 8: the board has no more");
  EXPECT_EQ(error_of("[[axis]]\naxes = 1\ndrive = \"hand\"\n", 0),
            ":2: axes: found 1; expected a board with servo ICs: this one has no motor outputs");
  EXPECT_EQ(error_of(axis_with("") + axis_with("")),
            ":5: axes: found \"1-2\"; expected each motor once: motor 1 has an axis already");
  EXPECT_EQ(error_of(axis_with("motor = 1\n")), ":4: motor: found 1; expected a table");
  EXPECT_EQ(error_of(axis_with("motor = { inertia = 0 }\n")), ":4: inertia: found 0; expected kg m2, 1e-9 or more");
  EXPECT_EQ(error_of(axis_with("motor = { inertia = nan }\n")), ":4: inertia: found nan; expected kg m2, 1e-9 or more");
  EXPECT_EQ(error_of(axis_with("motor = { viscous = \"1\" }\n")),
            ":4: viscous: found \"1\"; expected N m s, 0 or more");
  EXPECT_EQ(error_of(axis_with("motor = { pole_pairs = 0 }\n")),
            ":4: pole_pairs: found 0; expected an integer, 1 to 1000");
  EXPECT_EQ(error_of(axis_with("amplifier = { adc = 1 }\n")), ":4: adc: found 1; expected true or false");
  EXPECT_EQ(
      error_of(axis_with("stepper = { move_time = 5 }\n")),
      ":4: move_time: found 5; expected a time in quotes of a tick (8.5 ns) or more and up to an hour, for example "
      "\"2us\"");
  EXPECT_EQ(
      error_of(axis_with("stepper = { move_time = \"5 parsec\" }\n")),
      ":4: move_time: found \"5 parsec\"; expected a time in quotes of a tick (8.5 ns) or more and up to an hour, "
      "for example \"2us\"");
  EXPECT_EQ(error_of(axis_with("encoder = { lines = 0 }\n")), ":4: lines: found 0; expected an integer, 1 to 1000000");
  EXPECT_EQ(error_of(axis_with("encoder = { lines = 10, dark_lines = [10] }\n")),
            ":4: dark_lines: found 10; expected lines 0 to 9");
  EXPECT_EQ(error_of(axis_with("encoder = { wiring = \"loose\" }\n")),
            ":4: wiring: found \"loose\"; expected one of none, halls, complements, halls-on-abc");
  EXPECT_EQ(error_of(axis_with("brake = { opened_by = 1 }\n")), ":4: key torque is missing; expected torque = ...");
  EXPECT_EQ(error_of(axis_with("brake = { torque = 0, opened_by = 1 }\n")),
            ":4: torque: found 0; expected N m, above 0");
  EXPECT_EQ(error_of(axis_with("brake = { torque = 1, opened_by = 9 }\n")),
            ":4: opened_by: found 9; expected motors 1 to 8: the board has no more");
  EXPECT_EQ(error_of(axis_with("brake = { torque = 1, opened_by = 1 }\n")),
            ":2: axes: found \"1-2\"; expected an axis that can be: axis: a brake without a motor");
  EXPECT_EQ(error_of(axis_with("home = { from = 5, to = 5 }\n")), ":4: to: found 5; expected a place above `from`");
  EXPECT_EQ(error_of(axis_with("home = { from = 5 }\n")), ":4: key to is missing; expected to = ...");
  EXPECT_EQ(error_of(axis_with("noise = { shortest = \"1us\" }\n")), ":4: key every is missing; expected every = ...");
  EXPECT_EQ(error_of(axis_with("noise = { every = \"1ms\", pins = [\"enc_x\"] }\n")).substr(0, 60),
            ":4: pins: found \"enc_x\"; expected pins in quotes, of enc_a, ");
  EXPECT_EQ(error_of(axis_with("noise = { every = \"1ms\", pins = [\"fault\"] }\n")),
            ":2: axes: found \"1-2\"; expected an axis that can be: axis: noise on a pin of others");
}

TEST(PlantFile, MistakesOfIncidents) {
  EXPECT_EQ(error_of(axis_with("[[incident]]\naxes = 1\ntrip = \"i2t\"\n")),
            ":4: key at is missing; expected at = ...");
  EXPECT_EQ(
      error_of(axis_with("[[incident]]\nat = \"1ms\"\naxes = 1\n")).find("expected one of trip, cut, load, turn") !=
          std::string::npos,
      true);
  EXPECT_EQ(error_of(axis_with("[[incident]]\nat = \"1ms\"\naxes = 3\nload = 1\n")),
            ":6: axes: found 3; expected motors that have an [[axis]]: motor 3 has none");
  EXPECT_EQ(error_of(axis_with("[[incident]]\nat = \"1ms\"\naxes = 1\nturn = 4\n")),
            ":4: key within is missing; expected within = ...");
  EXPECT_EQ(
      error_of("[[axis]]\naxes = 1\ndrive = \"stepper\"\n[[incident]]\nat = \"1ms\"\naxes = 1\nturn = 4\nwithin = "
               "\"1ms\"\n"),
      ":7: turn: found 4; expected an axis with drive = \"hand\": motor 1 has another");
  EXPECT_EQ(error_of(axis_with("[[incident]]\nat = \"1ms\"\naxes = 1\ntrip = \"boredom\"\n")).substr(0, 44),
            ":7: trip: found \"boredom\"; expected one of o");
}

TEST(PlantFile, ConvertersHave16Or18Bits) {
  EXPECT_EQ(error_of("dac_bits = 17\n[[axis]]\naxes = 1\ndrive = \"torque\"\n"),
            ":1: dac_bits: found 17; expected 16 or 18");
}

TEST(PlantFile, AFileThatIsNone) {
  EXPECT_EQ(error_of("axis = [").substr(0, 3), ":1:");
  try {
    read_plant_file("/nowhere/x.toml", kTwoIcs, 1);
    FAIL() << "expected an error";
  } catch (const UsageError& e) { EXPECT_STREQ(e.what(), "/nowhere/x.toml: cannot be read; expected a plant in TOML"); }
}

}  // namespace
}  // namespace brick
