// Servo IC (DSPGATE1): 32 addresses of X and Y words on the bus side, PHASE and SERVO pins on the clock side. The
// global registers, the clock chain and four channels. Bus on clk_ref_i, clock chain on clk_pwm_i, asynchronous reset.
// docs/servo_ic.md.
`default_nettype none

module servo_ic (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  // bus: we_i is high for the one clk_ref edge that writes; rdata_o follows the address, 0 when not selected
  input  wire logic        sel_i,
  input  wire logic        x_i,
  input  wire logic [4:0]  addr_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  input  wire logic        rd_i,         // this clk_ref edge takes rdata_o as a read's sample
  output logic [23:0]      rdata_o,
  // clock pins
  input  wire logic        phase_i,
  input  wire logic        servo_i,
  output logic             phase_o,
  output logic             servo_o,
  output logic             phase_oe_o,
  output logic             servo_oe_o,
  // channels: fields as in servo_channels
  input  wire logic        trip_i,       // the watchdog has tripped: all outputs off
  input  wire logic        trip_d_i,     // it trips with the coming edge of clk_ref, or has; 0 where nobody knows
  input  wire logic [47:0] pins_i,
  input  wire logic [3:0]  adc_a_i,
  input  wire logic [3:0]  adc_b_i,
  output logic [3:0]       equ_o,        // as in motor_o, for the interrupt controller
  output logic [motor_pins_pkg::Stride-1:0] motor_o
);

  logic [11:0] clock_dividers;
  logic        phase_ext, servo_ext;
  logic [3:0]  phase_div, servo_div;
  logic [23:0] dac_strobe, adc_strobe;
  logic [7:0]  deadtime;
  logic [14:0] max_count;
  logic [23:0] ic_rdata, channel_rdata;

  servo_ic_regs u_regs (
    .clk_ref_i, .rst_ni,
    .sel_i, .x_i, .addr_i, .we_i, .wdata_i, .trip_i, .rdata_o(ic_rdata),
    .clock_dividers_o(clock_dividers), .phase_ext_o(phase_ext), .servo_ext_o(servo_ext),
    .phase_div_o(phase_div), .servo_div_o(servo_div), .dac_strobe_o(dac_strobe), .adc_strobe_o(adc_strobe),
    .deadtime_o(deadtime), .max_count_o(max_count)
  );

  logic [16:0] cnt;
  logic        turn, phase_rise, phase_fall, servo_fall;

  clock_gen u_clock_gen (
    .clk_pwm_i, .rst_ni,
    .max_count_i(max_count), .phase_div_i(phase_div), .servo_div_i(servo_div),
    .phase_ext_i(phase_ext), .servo_ext_i(servo_ext), .phase_i, .servo_i,
    .phase_o, .servo_o, .phase_oe_o, .servo_oe_o,
    .cnt_o(cnt), .turn_o(turn),
    .phase_rise_o(phase_rise), .phase_fall_o(phase_fall), .servo_fall_o(servo_fall)
  );

  logic [23:0] pwm;
  logic [3:0]  pulse, dir, dac_a, dac_b, aena, equ;
  logic        dac_clk, dac_strobe_pin, adc_clk, adc_strobe_pin;
  servo_channels u_channels (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .sel_i, .x_i, .addr_i, .we_i, .wdata_i, .rd_i, .rdata_o(channel_rdata),
    .trip_i, .trip_d_i,
    .dividers_i(clock_dividers), .dac_strobe_i(dac_strobe), .adc_strobe_i(adc_strobe), .deadtime_i(deadtime),
    .cnt_i(cnt), .turn_i(turn), .phase_rise_i(phase_rise), .phase_fall_i(phase_fall), .servo_fall_i(servo_fall),
    .pins_i, .adc_a_i, .adc_b_i,
    .pwm_o(pwm), .pulse_o(pulse), .dir_o(dir), .dac_a_o(dac_a), .dac_b_o(dac_b), .aena_o(aena), .equ_o(equ),
    .dac_clk_o(dac_clk), .dac_strobe_o(dac_strobe_pin), .adc_clk_o(adc_clk), .adc_strobe_o(adc_strobe_pin)
  );
  assign rdata_o = ic_rdata | channel_rdata;
  assign equ_o   = equ;

  // What moves with clk_ref only stands apart, so that a simulator packs it only then: docs/simulation-speed.md.
  logic [motor_pins_pkg::Stride-1:0] slow, fast;
  always_comb begin
    slow = '0;
    slow[motor_pins_pkg::PulseLsb +: motor_pins_pkg::PulseWidth]         = pulse;
    slow[motor_pins_pkg::DirLsb +: motor_pins_pkg::DirWidth]             = dir;
    slow[motor_pins_pkg::DacALsb +: motor_pins_pkg::DacAWidth]           = dac_a;
    slow[motor_pins_pkg::DacBLsb +: motor_pins_pkg::DacBWidth]           = dac_b;
    slow[motor_pins_pkg::AenaLsb +: motor_pins_pkg::AenaWidth]           = aena;
    slow[motor_pins_pkg::EquLsb +: motor_pins_pkg::EquWidth]             = equ;
    slow[motor_pins_pkg::DacStrobeLsb +: motor_pins_pkg::DacStrobeWidth] = dac_strobe_pin;
    slow[motor_pins_pkg::AdcStrobeLsb +: motor_pins_pkg::AdcStrobeWidth] = adc_strobe_pin;
  end
  always_comb begin
    fast = '0;
    fast[motor_pins_pkg::PwmLsb +: motor_pins_pkg::PwmWidth]       = pwm;
    fast[motor_pins_pkg::DacClkLsb +: motor_pins_pkg::DacClkWidth] = dac_clk;
    fast[motor_pins_pkg::AdcClkLsb +: motor_pins_pkg::AdcClkWidth] = adc_clk;
  end
  assign motor_o = slow | fast;

endmodule : servo_ic

`default_nettype wire
