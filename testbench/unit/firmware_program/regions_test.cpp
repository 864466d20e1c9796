// Order rules of the buffers in user memory (firmware:4.2), over all pairs of regions.
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

struct Region {
  const char* name;
  region_kind kind;
  std::uint32_t cs;  // or motor
  int place;         // in memory, counted from the top (firmware:4.2); written here independently of the firmware
};

// COMP 32..1 | TCOMP 32..1 | BLCOMP 32..1 | TBUF | CCBUF 16..1 | LOOKAHEAD 16..1 | ROTARY 16..1 | GATHER
std::vector<Region> all_regions() {
  std::vector<Region> list;
  const struct {
    const char* name;
    region_kind kind;
    int layer;
    std::uint32_t last;  // owner, from 0
  } kinds[] = {{"COMP", REGION_COMP, 0, 31},           {"TCOMP", REGION_TCOMP, 1, 31},
               {"BLCOMP", REGION_BLCOMP, 2, 31},       {"CCBUF", REGION_CCBUF, 4, 15},
               {"LOOKAHEAD", REGION_LOOKAHEAD, 5, 15}, {"ROTARY", REGION_ROTARY, 6, 15}};
  for (const auto& k : kinds)
    for (const std::uint32_t owner : {0u, 1u, 7u, k.last})
      list.push_back({k.name, k.kind, owner, 100 * k.layer + 32 - static_cast<int>(owner)});
  list.push_back({"TBUF", REGION_TBUF, 0, 300});
  list.push_back({"GATHER", REGION_GATHER, 0, 700});
  return list;
}

std::string name_of(const Region& r) { return std::string(r.name) + " &" + std::to_string(r.cs + 1); }

class Regions : public FirmwareTest {};

TEST_F(Regions, DefineIsRefusedWhileSomethingLivesBelow) {
  BRICK_COVERS("BIN-2");
  for (const Region& there : all_regions())
    for (const Region& made : all_regions()) {
      regions_initialize();
      ASSERT_EQ(region_define(there.kind, there.cs, 40), ERR_NONE);
      const error_t expected = made.place > there.place ? ERR_NONE : ERR_DATA;  // the same region again is refused, too
      EXPECT_EQ(region_define(made.kind, made.cs, 30), expected)
          << name_of(made) << " while " << name_of(there) << " exists";
      EXPECT_EQ(region_open_words(), 26624u - 40u - (expected == ERR_NONE ? 30u : 0u));
    }
}

TEST_F(Regions, DeleteIsRefusedWhileSomethingLivesBelow) {
  BRICK_COVERS("BIN-2");
  for (const Region& first : all_regions())
    for (const Region& second : all_regions()) {
      if (second.place <= first.place) continue;
      regions_initialize();
      ASSERT_EQ(region_define(first.kind, first.cs, 40), ERR_NONE);
      ASSERT_EQ(region_define(second.kind, second.cs, 30), ERR_NONE);
      EXPECT_EQ(region_delete(first.kind, first.cs), ERR_DATA) << name_of(first) << " above " << name_of(second);
      EXPECT_EQ(region_delete(second.kind, second.cs), ERR_NONE);
      EXPECT_EQ(region_delete(first.kind, first.cs), ERR_NONE);
      EXPECT_EQ(region_open_words(), 26624u);
    }
}

TEST_F(Regions, RegionsAreStackedWithoutGapsFromTheTopDown) {
  std::uint32_t base = 26624 - 100;
  ASSERT_EQ(region_define_user(100), ERR_NONE);
  for (const region_kind kind : {REGION_COMP, REGION_BLCOMP, REGION_CCBUF, REGION_LOOKAHEAD, REGION_ROTARY})
    for (const std::uint32_t owner : {15u, 4u, 0u}) {
      const std::uint32_t words = 10 + owner;
      ASSERT_EQ(region_define(kind, owner, words), ERR_NONE);
      base -= words;
      EXPECT_EQ(region_base(kind, owner), base);
      EXPECT_EQ(region_words(kind, owner), words);
    }
  ASSERT_EQ(region_resize_fixed(50), ERR_NONE);
  ASSERT_EQ(region_define_rest(), ERR_NONE);
  EXPECT_EQ(region_base(REGION_GATHER, 0), 50u);
  EXPECT_EQ(region_words(REGION_GATHER, 0), base - 50);
  EXPECT_EQ(region_open_words(), 0u);
}

// Programs and regions grow towards each other.
TEST_F(Regions, FixedProgramsGrowWhateverThereIs) {
  for (const Region& there : all_regions()) {
    regions_initialize();
    ASSERT_EQ(region_define(there.kind, there.cs, 40), ERR_NONE);
    const std::uint32_t base = region_base(there.kind, there.cs);
    EXPECT_EQ(region_resize_fixed(26584), ERR_NONE) << name_of(there);
    EXPECT_EQ(region_open_words(), 0u);
    EXPECT_EQ(region_resize_fixed(26585), ERR_NO_ROOM) << name_of(there);
    EXPECT_EQ(region_resize_fixed(7), ERR_NONE) << name_of(there);
    EXPECT_EQ(region_open_words(), 26577u);
    EXPECT_EQ(region_base(there.kind, there.cs), base) << name_of(there);
  }
}

TEST_F(Regions, NoRoomIsError6AndChangesNothing) {
  EXPECT_EQ(platform::host("&2DEF ROT 26625"), "ERR006");
  EXPECT_EQ(platform::host("&2DEF ROT 26624"), "");
  EXPECT_EQ(platform::host("&1DEF ROT 1"), "ERR006");
  EXPECT_EQ(platform::host("SIZE"), "0");
  EXPECT_EQ(platform::host("DEF GAT"), "ERR006");
  EXPECT_EQ(platform::host("&2DEL ROT"), "");
  EXPECT_EQ(platform::host("SIZE"), "26624");
}

TEST_F(Regions, SizesOfLookaheadAndGather) {
  BRICK_COVERS("I18-3");
  EXPECT_EQ(platform::host("&2DEFINE LOOKAHEAD 50,10"), "");  // no motors: 6 words a segment, 2 an output
  EXPECT_EQ(platform::host("SIZE"), std::to_string(26624 - 50 * 6 - 10 * 2));
  EXPECT_EQ(platform::host("&1#1->1000X #2->1000Y #3->1000Z"), "");
  EXPECT_EQ(platform::host("&1DEF LOOK 20,5"), "");  // 3 motors: 10 words a segment
  EXPECT_EQ(platform::host("SIZE"), std::to_string(26624 - 320 - 20 * 10 - 10));
  EXPECT_EQ(platform::host("DEF GAT 1000"), "");
  EXPECT_EQ(platform::host("SIZE"), std::to_string(26624 - 320 - 210 - 1000));
  EXPECT_EQ(platform::host("DEF GAT"), "") << "the buffer there is";
  EXPECT_EQ(platform::host("SIZE"), std::to_string(26624 - 320 - 210 - 1000));
}

TEST_F(Regions, DeleteAllTempsRemovesEverything) {
  for (const char* command : {"DELETE ALL TEMPS", "DEL ALL TEMP", "DELETE ALL"}) {
    ASSERT_EQ(platform::host("&16DEF CCBUF 3 &1DEF CCBUF 3 &9DEF LOOK 5,5 &4DEF ROT 50 &2DEF ROT 60 DEF GAT"), "");
    EXPECT_EQ(platform::host("SIZE"), "0");
    EXPECT_EQ(platform::host(command), "") << command;
    EXPECT_EQ(platform::host("SIZE"), "26624");
    EXPECT_EQ(platform::host("&4PR"), "ERR003");
  }
}

// firmware:4.3/15: command files delete them before they load what is theirs.
TEST_F(Regions, WhatThereIsNoBufferOfIsDeletedAllTheSame) {
  ASSERT_EQ(platform::host("OPEN PLC 3 CLEAR P1=1 CLOSE &1DEF ROT 100"), "");
  const std::string size = platform::host("SIZE");
  EXPECT_EQ(platform::host("DELETE TRACE DELETE PLCC 3 DEL TRACE"), "");
  EXPECT_EQ(platform::host("SIZE"), size);
  EXPECT_EQ(platform::host("LIST PLC 3"), "P1=1|RET") << "a compiled one is another";
  EXPECT_EQ(platform::host("DELETE PLCC 32"), "ERR003") << "there are 32 of them, from 0";
}

TEST_F(Regions, ArgumentsAreChecked) {
  for (const char* text : {"DEF ROT", "DEF ROT 0", "DEF ROT -5", "DEF ROT 1.5", "DEF LOOK 10", "DEF LOOK 0,5",
                           "DEF CCBUF", "DEF UNKNOWN 5", "DEL UNKNOWN", "DEF GAT 0"})
    EXPECT_EQ(platform::host(text), "ERR003") << text;
}

TEST_F(Regions, ResetForgetsAll) {
  BRICK_COVERS("BIN-2");
  ASSERT_EQ(platform::host("DEF ROT 20"), "");
  platform::power_up();
  EXPECT_EQ(platform::host("PR"), "ERR003");
  EXPECT_EQ(platform::host("SIZE"), "26624");
}

}  // namespace
