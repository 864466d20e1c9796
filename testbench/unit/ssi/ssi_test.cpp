// Registers of both products: which bits there are (servo-ic:11.3, servo-ic:11.4), on both engines.
#include <gtest/gtest.h>

#include "testbench/unit/ssi/ssi_rig.h"

namespace brick {
namespace {

template <class Rig>
class SsiWords : public ::testing::Test {
 protected:
  void check(bool geo, const std::function<std::uint32_t(bool x, unsigned address)>& bits) {
    rig.reset(geo);
    for (const std::uint32_t value : {0xFFFFFFu, 0x5A3CA5u, 0xA5C35Au, 0x000000u}) {
      for (unsigned address = 0; address < 64; ++address)
        for (const bool x : {false, true}) rig.write(x, address, value);
      for (unsigned address = 0; address < 64; ++address)
        for (const bool x : {false, true})
          ASSERT_EQ(rig.read(x, address), value & bits(x, address)) << (x ? "X" : "Y") << address << " " << value;
    }
  }
  SsiBench<Rig> rig;
};
using Engines = ::testing::Types<RtlSsiRig, ModelSsiRig>;
TYPED_TEST_SUITE(SsiWords, Engines);

TYPED_TEST(SsiWords, BrickHoldsTheBitsThatExist) {
  this->check(false, [](bool x, unsigned address) -> std::uint32_t {
    if (!x || address < 0x20) return 0;
    if (address == 0x2F || address == 0x3F) return 0xFFF3FF;
    return address % 4 == 0 ? 0xF83F : 0;
  });
}

TYPED_TEST(SsiWords, GeoHoldsTheBitsThatExist) {
  this->check(true, [](bool x, unsigned address) -> std::uint32_t {
    if (!x) return 0;
    return address == 0x14 || address == 0x34 ? 0xF : address == 0x15 ? 3 : 0;
  });
}

TYPED_TEST(SsiWords, WordsAreIndependent) {
  this->rig.reset(false);
  for (unsigned channel = 0; channel < 8; ++channel) this->rig.write(true, 0x20 + 4 * channel, 12 + channel);
  this->rig.write(true, 0x2F, 0x123002);
  this->rig.write(true, 0x3F, 0x456003);
  for (unsigned address = 0; address < 64; ++address) this->rig.write(false, address, 0xFFFFFF);
  for (unsigned channel = 0; channel < 8; ++channel) EXPECT_EQ(this->rig.read(true, 0x20 + 4 * channel), 12 + channel);
  EXPECT_EQ(this->rig.read(true, 0x2F), 0x123002u);
  EXPECT_EQ(this->rig.read(true, 0x3F), 0x456003u);
}

TYPED_TEST(SsiWords, AreZeroAfterAReset) {
  for (const bool geo : {false, true}) {
    this->rig.reset(geo);
    for (unsigned address = 0; address < 64; ++address)
      for (const bool x : {false, true}) this->rig.write(x, address, 0xFFFFFF);
    this->rig.reset(geo);
    for (unsigned address = 0; address < 64; ++address)
      for (const bool x : {false, true}) EXPECT_EQ(this->rig.read(x, address), 0u) << (x ? "X" : "Y") << address;
  }
}

}  // namespace
}  // namespace brick
