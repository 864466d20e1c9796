// Everything that is wired to the motor side of a controller: axes and, for each servo IC, the serial converters that
// they share. Attached to a machine as its peer (systemc/machine/motor_peer.h). Equal seeds and equal outputs give
// equal inputs. docs/plant.md
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "systemc/machine/motor_peer.h"
#include "testbench/plant/adc_peer.h"
#include "testbench/plant/axis.h"
#include "testbench/plant/dac_peer.h"

namespace brick::plant {

// What happens to an axis at a time, whatever the controller does.
struct Incident {
  Tick at = 0;
  std::size_t axis = 0;  // in PlantParameters::axes
  std::optional<Amplifier::Fault> trip;
  std::optional<std::uint16_t> cut;  // wires that are cut from then on, all others whole
  std::optional<double> load;        // N m
  std::int64_t turn = 0;             // kHand: counts, evenly within `turn_time`
  Tick turn_time = 1;
};

struct PlantParameters {
  std::uint64_t seed = 1;
  Tick step = 1152;  // of the motors' equations: 1/102400 s
  unsigned dac_bits = 18;
  unsigned adc_header = 4;
  std::vector<AxisParameters> axes;
  std::vector<Incident> incidents;
};

class Plant : public MotorPeer {
 public:
  explicit Plant(const PlantParameters& parameters);

  Axis& axis(std::size_t index) {
    next_ = 0;  // whoever has it may change it
    return *axes_.at(index);
  }
  const Axis& axis(std::size_t index) const { return *axes_.at(index); }
  std::size_t axes() const { return axes_.size(); }
  const DacPeer& dac(unsigned ic) const { return converters_.at(ic).dac; }
  const AdcPeer& adc(unsigned ic) const { return converters_.at(ic).adc; }

  std::uint32_t ics() const override;
  void begin(MotorDigest* digest) override;
  MotorOutputs watched(unsigned ic) const override;
  std::uint16_t drives(unsigned ic, unsigned channel) const override;
  MotorOutputs stops(unsigned ic) const override;
  Tick next_event() const override { return next_; }
  std::uint8_t ssi_channels() const override;
  void ssi_clocked(Tick tick, std::uint8_t before, std::uint8_t after) override;
  std::uint8_t ssi_data(Tick now) override;
  void changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) override;
  bool step(Tick now, MotorInputPins& inputs) override;

 private:
  void happen(const Incident& incident);

  struct Converters {
    DacPeer dac;
    AdcPeer adc;
    bool uses_dac = false, uses_adc = false;
  };
  void serial_pins(Tick tick, unsigned ic, Converters& converters, const MotorOutputs& before,
                   const MotorOutputs& after);
  void serial_digest(unsigned ic, Converters& converters, const MotorOutputs& before, const MotorOutputs& after);
  void start_conversion(unsigned ic, AdcPeer& adc);
  void command(unsigned ic, const AdcPeer& adc);
  bool show_adc(unsigned ic, const Converters& converters, MotorInputs& inputs) const;
  std::vector<std::unique_ptr<Axis>> axes_;
  std::map<unsigned, Converters> converters_;  // by IC
  std::vector<Incident> incidents_;            // in order of time
  std::size_t happened_ = 0;                   // of them
  MotorDigest* digest_ = nullptr;
  Tick next_ = 0;
};

}  // namespace brick::plant
