// Absolute encoders of a plant's axes: which position of the shaft a frame has, revolutions and all, and at which
// wires.
#include "testbench/unit/covers.h"
#include "testbench/unit/plant/plant_rig.h"

namespace brick::plant {
namespace {

constexpr Tick kHalf = 48;  // of a serial period

// Axes 1 and 8 have encoders of 4096 steps a revolution and 4 bits of revolutions, on shafts with 4000 counts.
PlantParameters two_encoders() {
  PlantParameters plant;
  for (const unsigned ic : {0u, 1u}) {
    AxisParameters axis;
    axis.ic = ic;
    axis.channel = ic == 0 ? 0 : 3;
    axis.start = ic == 0 ? -1000 : 10;
    axis.absolute.emplace();
    axis.absolute->bits = 16;
    axis.absolute_turns = 4;
    plant.axes.push_back(axis);
  }
  return plant;
}

class AbsoluteRig : public PlantRig {
 public:
  explicit AbsoluteRig(Plant& plant) : PlantRig(plant) {}
  // Clocks 17 times; the level before each rise but the first.
  unsigned frame(unsigned channel) {
    unsigned word = 0;
    for (int clock = 0; clock < 17; ++clock) {
      move(channel, false);
      word = clock > 0 ? word << 1 | (peer_.ssi_data(now_) >> channel & 1u) : 0;
      move(channel, true);
    }
    run(3000);
    return word;
  }

 private:
  void move(unsigned channel, bool level) {
    const auto bit = static_cast<std::uint8_t>(1u << channel);
    const auto other = static_cast<std::uint8_t>(0xFFu & ~bit);
    peer_.ssi_clocked(now_, level ? other : 0xFF, level ? 0xFF : other);
    stopped_ = true;
    run(kHalf);
  }
};

TEST(AbsoluteEncoder, HasTheShaftsPositionAndItsRevolutions) {
  BRICK_COVERS("SSI-1");
  Plant plant(two_encoders());
  EXPECT_EQ(plant.ssi_channels(), 0x81u);
  AbsoluteRig rig(plant);
  rig.run(10);
  EXPECT_EQ(rig.frame(0), 0x10000u - 1024) << "a quarter below zero";
  EXPECT_EQ(rig.frame(7), 10u) << "10 counts are 10.24 steps";
  plant.axis(0).turn(9000, 20'000);
  rig.run(30'000);
  EXPECT_EQ(rig.frame(0), 2u * 4096) << "8000 counts";
  EXPECT_EQ(rig.frame(7), 10u);
  plant.axis(1).turn(16 * 4000, 20'000);
  rig.run(30'000);
  EXPECT_EQ(rig.frame(7), 10u) << "sixteen revolutions are none";
  plant.axis(1).turn(-11, 20'000);
  rig.run(30'000);
  EXPECT_EQ(rig.frame(7), 0xFFFEu) << "-1 count is -1.024 steps";
}

// The first fall holds what the shaft has then, however far it turns until the last bit.
TEST(AbsoluteEncoder, HoldsThePositionOfTheFirstFall) {
  BRICK_COVERS("SSI-1");
  Plant plant(two_encoders());
  AbsoluteRig rig(plant);
  plant.axis(0).turn(8000, 16'000);  // a count in two ticks, from tick 0 on
  rig.run(4'000);
  const std::int64_t counts = plant.axis(0).counts(rig.now());
  EXPECT_EQ(counts, 1000);
  EXPECT_EQ(rig.frame(0), 1024u);
}

TEST(AbsoluteEncoder, IsNoneWhereThereIsNoSerialInput) {
  PlantParameters parameters = two_encoders();
  parameters.axes[1].ic = 2;
  EXPECT_THROW(Plant{parameters}, std::invalid_argument);
}

}  // namespace
}  // namespace brick::plant
