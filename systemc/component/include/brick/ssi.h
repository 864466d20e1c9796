// Serial encoder inputs (SSI) of a Geo Brick LV or a Geo PMAC. docs/ssi.md, servo-ic:11.3, servo-ic:11.4.
#pragma once

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>
#include <brick/pins/ssi.h>

namespace brick::component {

class Ssi final : public Component, public SsiPins {
 public:
  Ssi(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  // 64 words X and 64 Y of 24 bits, in the low bits of 4 bytes: X of offset n at 8 n + 4, Y at 8 n. A Brick has $20 to
  // $3F of them, a Geo PMAC $14 to $16 and $34 to $36. A read of a position holds its high part.
  tlm_utils::simple_target_socket_optional<Ssi> registers;

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
