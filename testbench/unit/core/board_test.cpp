// What an engine need not do (systemc/core/board.h): a board of clocks alone is a board.
#include "systemc/core/board.h"

#include <gtest/gtest.h>

#include <memory>

#include "systemc/core/model_block.h"

namespace brick {
namespace {

class Clocks : public Board {
 public:
  explicit Clocks(bool* gone) : gone_(gone) {}
  ~Clocks() override { *gone_ = true; }
  Tick now() const override { return now_; }
  void set_inputs(const BoardInputs& inputs) override { inputs_ = inputs; }
  const BoardOutputs& outputs() const override { return outputs_; }
  Tick run_until(Tick limit, const BoardOutputs&) override {
    outputs_.set(pin::kTxde, 1);
    return now_ = limit;
  }

  BoardInputs inputs_{};

 private:
  BoardOutputs outputs_{};
  Tick now_ = 0;
  bool* gone_;
};

TEST(BoardFace, LeavesOutWhatAnEngineHasNot) {
  bool gone = false;
  std::unique_ptr<Board> board = std::make_unique<Clocks>(&gone);
  board->run_until(7);
  EXPECT_EQ(board->quiet_until(BoardOutputs{}), 7) << "it cannot predict";
  EXPECT_TRUE(board->outputs().get(pin::kTxde) == 1 && board->port_a_at_once() == board->outputs()) << "flip-flops";
  EXPECT_FALSE(board->dpram_word(0)) << "it cannot say";
  EXPECT_EQ(board->motor_digest(), nullptr);
  BoardInputs inputs{};
  inputs.rst_n = true;
  board->set_port_a(inputs);
  EXPECT_TRUE(static_cast<Clocks&>(*board).inputs_.rst_n) << "pins of Port A are inputs as all";
  board->set_motor_inputs(0, MotorInputs{});
  board->watch_motors(1);
  board->stop_on_motor(0, kAllMotorOutputs);
  EXPECT_TRUE(board->motor_outputs(0) == MotorOutputs{}) << "an IC that is not built shows zeros";
  EXPECT_EQ(board->run_until(20), 20);
  board.reset();
  EXPECT_TRUE(gone);
}

// Whoever owns them need not know of which kind they are.
struct Block : ModelBlock {
  explicit Block(bool* gone) : gone_(gone) {}
  ~Block() override { *gone_ = true; }
  Tick next_event() const override { return kNever; }
  void advance(Tick) override {}
  void reset(Tick) override {}
  bool* gone_;
};

struct Digest : MotorDigest {
  explicit Digest(bool* gone) : gone_(gone) {}
  ~Digest() override { *gone_ = true; }
  ConverterWords dac_lines(unsigned) override { return {}; }
  AdcStream adc_stream(unsigned) override { return {}; }
  void send_adc(unsigned, const ConverterWords&) override {}
  unsigned adc_lines(unsigned, bool) override { return 0; }
  PwmTimes pwm_times(unsigned, unsigned) override { return {}; }
  bool* gone_;
};

TEST(BoardFace, GoesAsWhatItIs) {
  bool block = false, digest = false;
  std::unique_ptr<ModelBlock>(std::make_unique<Block>(&block)).reset();
  std::unique_ptr<MotorDigest>(std::make_unique<Digest>(&digest)).reset();
  EXPECT_TRUE(block);
  EXPECT_TRUE(digest);
}

}  // namespace
}  // namespace brick
