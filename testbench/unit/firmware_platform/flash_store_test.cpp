// The flash store by itself (docs/save.md): power that goes at every word of a SAVE, also of two in a row and with a
// torn last word, and every bit of a small image turned over. Images are a few words that the test makes up.
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <vector>

#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/base/crc32.h"
#include "firmware/image/flash_store.h"
}

namespace brick {
namespace {

using Words = std::vector<std::uint32_t>;

struct Image {
  Words first, second;
  bool operator==(const Image& o) const { return first == o.first && second == o.second; }
};

void PrintTo(const Image& image, std::ostream* out) {
  *out << image.first.size() << " and " << image.second.size() << " words";
  if (!image.first.empty()) *out << ", " << std::hex << image.first[0];
}

void save(const Image& image) {
  flash_store_begin();
  for (const std::uint32_t word : image.first) flash_store_put(word);
  flash_store_second_part();
  for (const std::uint32_t word : image.second) flash_store_put(word);
  flash_store_commit();
}

struct Found {
  flash_store_t state;
  Image image;
};

// As the start-up sees it: an image of which the second part is not whole is damaged too.
Found found() {
  flash_image image{};
  Found f{flash_store_find(&image), {}};
  if (f.state != FLASH_STORE_FOUND) return f;
  if (!flash_store_second_is_whole(&image)) return {FLASH_STORE_DAMAGED, {}};
  f.image.first.assign(image.part[0], image.part[0] + image.words[0]);
  f.image.second.assign(image.part[1], image.part[1] + image.words[1]);
  return f;
}

std::uint32_t* slot(unsigned index) { return fake_hal_flash() + index * FLASH_SLOT_WORDS; }

// The checksum once more, bit by bit.
std::uint32_t crc_of_bits(std::uint32_t sum, std::uint32_t bits, unsigned count) {
  for (unsigned i = 0; i < count; ++i) {
    const bool one = ((sum ^ bits >> i) & 1) != 0;
    sum = sum >> 1 ^ (one ? 0xEDB88320u : 0);
  }
  return sum;
}

std::uint32_t crc_of(const Words& words, std::uint32_t sum = CRC32_BEGIN) {
  for (const std::uint32_t word : words) sum = crc_of_bits(sum, word, 32);
  return sum;
}

class FlashStore : public ::testing::Test {
 protected:
  void SetUp() override {
    fake_hal_power_on(0x3);
    crc32_initialize();
  }

  Image random_image(std::size_t first, std::size_t second) {
    Image image{Words(first), Words(second)};
    for (auto* part : {&image.first, &image.second})
      for (std::uint32_t& word : *part) word = static_cast<std::uint32_t>(random_());
    return image;
  }

  // SAVE with power for `writes` words; what the store then has.
  Found cut(const Image& image, std::uint32_t writes, std::uint32_t torn) {
    fake_hal_power_goes(writes, torn);
    save(image);
    fake_hal_power_goes(FAKE_POWER_STAYS, 0);
    return found();
  }

  std::mt19937 random_{random_seed(1)};
};

TEST_F(FlashStore, CrcIsThatOfEthernet) {
  // The check value of the nine characters 123456789, published with the polynomial.
  std::uint32_t sum = crc32_add(crc32_add(CRC32_BEGIN, 0x34333231), 0x38373635);
  EXPECT_EQ(~crc_of_bits(sum, '9', 8), 0xCBF43926u);
  const Image image = random_image(200, 0);
  sum = CRC32_BEGIN;
  for (const std::uint32_t word : image.first) sum = crc32_add(sum, word);
  EXPECT_EQ(sum, crc_of(image.first));
  EXPECT_EQ(crc32_words(CRC32_BEGIN, image.first.data(), 200), sum);
}

// Layout of docs/save.md, word by word.
TEST_F(FlashStore, LaysOutAnImage) {
  EXPECT_EQ(found().state, FLASH_STORE_EMPTY);
  const Image image{{0x11, 0x22, 0x33}, {0x44, 0x55}};
  save(image);
  ASSERT_EQ(found().state, FLASH_STORE_FOUND);
  EXPECT_EQ(found().image, image);
  const std::uint32_t* words = slot(0);
  EXPECT_EQ(words[0], 0x42524B35u);
  EXPECT_EQ(words[3], 3u);
  EXPECT_EQ(words[4], 2u);
  EXPECT_EQ(words[5], ~crc_of({0x44, 0x55}));
  EXPECT_EQ(words[1], ~crc_of({0x11, 0x22, 0x33, words[2], words[3], words[4], words[5]}));
  EXPECT_EQ((Words{words + 6, words + 11}), (Words{0x11, 0x22, 0x33, 0x44, 0x55}));
  EXPECT_EQ(slot(1)[0], 0u) << "outdated";
  save({{0x66}, {}});
  EXPECT_EQ(slot(1)[0], 0x42524B35u);
  EXPECT_EQ(slot(1)[2], words[2] + 1);
  EXPECT_EQ(slot(0)[0], 0u);
  EXPECT_EQ(FLASH_SLOT_WORDS, 131072);
}

TEST_F(FlashStore, TakesAFullSlot) {
  const Image full = random_image(4096, FLASH_CAPACITY - 4096);
  for (int i = 0; i < 2; ++i) {
    save(full);
    EXPECT_EQ(found().image, full);
  }
}

// Old or new, and never neither: at each word, untorn and torn in several ways, from each slot.
TEST_F(FlashStore, PowerCutAtEveryWordLeavesOldOrNew) {
  unsigned old_ones = 0, new_ones = 0;
  for (const std::uint32_t torn : {0x00000000u, 0x0000FFFFu, 0xFFFF0000u, 0x5A5A5A5Au, 0x00FF00FFu, 0x80000001u}) {
    for (std::uint32_t writes = 0;; ++writes) {
      const Image before = random_image(5, 7), after = random_image(6, 4);
      save(before);
      const Found f = cut(after, writes, torn);
      ASSERT_EQ(f.state, FLASH_STORE_FOUND) << writes << " words, torn " << torn;
      ASSERT_TRUE(f.image == before || f.image == after) << writes << " words, torn " << torn;
      ++(f.image == before ? old_ones : new_ones);
      if (writes > 30) {
        ASSERT_TRUE(f.image == after) << "a SAVE that has ended counts";
        break;
      }
    }
  }
  // A SAVE is 18 writes: the state, 10 words, 5 of the header, the state, that of the other. The 17th counts, so 0 to
  // 16 leave the old image, a torn 17th too.
  EXPECT_GE(old_ones, 6u * 17);
  EXPECT_GE(new_ones, 6u * 13);
}

// The second SAVE finds what the first has left, cut between any two words of it.
TEST_F(FlashStore, TwoCutsInARowLeaveOneOfTheThree) {
  constexpr std::uint32_t kWrites = 12;  // 1 + 4 + 5 + 1 + 1, as above
  for (std::uint32_t first = 0; first <= kWrites; ++first) {
    for (std::uint32_t second = 0; second <= kWrites; ++second) {
      for (const std::uint32_t torn : {0u, 0x00FFFF00u}) {
        const Image before = random_image(2, 2), middle = random_image(2, 2), after = random_image(2, 2);
        save(before);
        const Found between = cut(middle, first, torn);
        ASSERT_EQ(between.state, FLASH_STORE_FOUND);
        const Found f = cut(after, second, torn);
        ASSERT_EQ(f.state, FLASH_STORE_FOUND) << first << " then " << second;
        ASSERT_TRUE(f.image == between.image || f.image == after) << first << " then " << second;
        if (second == kWrites) { ASSERT_TRUE(f.image == after); }
      }
    }
  }
}

TEST_F(FlashStore, TheVeryFirstSaveLeavesNothingOrAll) {
  for (std::uint32_t writes = 0; writes < 20; ++writes) {
    fake_hal_power_on(0x3);
    const Image image = random_image(3, 3);
    const Found f = cut(image, writes, 0);
    if (f.state == FLASH_STORE_FOUND)
      ASSERT_EQ(f.image, image) << writes;
    else
      ASSERT_EQ(f.state, FLASH_STORE_EMPTY) << writes;
    EXPECT_EQ(f.state == FLASH_STORE_FOUND, writes >= 13) << "the 13th word is the one that counts";
  }
}

// Between the last two words both images are whole: the sequence decides, also where it begins anew.
TEST_F(FlashStore, NewerOfTwoWholeOnesCountsAcrossTheEndOfTheSequence) {
  for (const std::uint32_t sequence : {0u, 0x7FFFFFFEu, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
    for (int from = 0; from < 2; ++from) {
      fake_hal_power_on(0x3);
      for (int i = 0; i <= from; ++i) save(random_image(1, 1));
      std::uint32_t* words = slot(static_cast<unsigned>(from));
      words[2] = sequence;
      words[1] = ~crc_of({words[6], words[2], words[3], words[4], words[5]});
      const Image before = found().image, after = random_image(1, 1);
      const Found f = cut(after, 1 + 2 + 4 + 1 + 1, 0);
      ASSERT_EQ(slot(0)[0], 0x42524B35u);
      ASSERT_EQ(slot(1)[0], 0x42524B35u);
      EXPECT_EQ(f.image, after) << sequence;
    }
  }
}

TEST_F(FlashStore, EveryBitOfAnImageCounts) {
  const Image older = random_image(4, 4), image = random_image(5, 6);
  save(older);
  save(image);  // in slot 1
  const std::size_t words = FLASH_WORD_DATA + 11;
  for (std::size_t word = 0; word < words; ++word) {
    for (unsigned bit = 0; bit < 32; ++bit) {
      slot(1)[word] ^= 1u << bit;
      EXPECT_EQ(found().state, FLASH_STORE_DAMAGED) << "word " << word << " bit " << bit;
      slot(1)[word] ^= 1u << bit;
    }
  }
  for (std::size_t word = 0; word < words; ++word) {  // nobody needs the outdated one
    for (unsigned bit = 0; bit < 32; ++bit) {
      slot(0)[word] ^= 1u << bit;
      EXPECT_EQ(found().image, image) << "word " << word << " bit " << bit;
      slot(0)[word] ^= 1u << bit;
    }
  }
}

TEST_F(FlashStore, LengthsThatNoSlotHasAreDamage) {
  for (const auto& [first, second] :
       {std::pair{0xFFFFFFFFu, 1u}, std::pair{1u, 0xFFFFFFFFu}, std::pair{0x80000000u, 0x80000000u},
        std::pair{131066u, 1u}, std::pair{131067u, 0u}, std::pair{0xFFFFFFFAu, 6u}, std::pair{4097u, 1u}}) {
    save(random_image(1, 1));
    std::uint32_t* words = slot(slot(0)[0] == 0x42524B35u ? 0 : 1);
    words[3] = first;
    words[4] = second;
    Words summed(words + 6, words + 6 + std::min(first, 5000u));
    summed.insert(summed.end(), {words[2], first, second, words[5]});
    words[1] = ~crc_of(summed);
    EXPECT_EQ(found().state, FLASH_STORE_DAMAGED) << first << ' ' << second;
  }
}

// What versions 0.5 and 0.6 wrote, and anything else that is no image.
TEST_F(FlashStore, UnknownContentIsDamageUntilANewImageCounts) {
  for (unsigned damaged = 0; damaged < 3; ++damaged) {
    for (std::uint32_t writes = 0; writes < 15; ++writes) {
      fake_hal_power_on(0x3);
      if (damaged != 1) slot(0)[0] = damaged == 0 ? 0x42524B33u : 0x42524B34u;
      if (damaged != 0) slot(1)[0] = 0x12345678u;
      EXPECT_EQ(found().state, FLASH_STORE_DAMAGED);
      const Image image = random_image(3, 3);
      const Found f = cut(image, writes, 0);
      const bool counts = writes >= 13;
      EXPECT_EQ(f.state, counts ? FLASH_STORE_FOUND : FLASH_STORE_DAMAGED) << damaged << ", " << writes;
      if (counts) { EXPECT_EQ(f.image, image); }
    }
  }
}

}  // namespace
}  // namespace brick
