// The four registers that serve a whole servo IC, in the X word at offset 4 of each channel: clock control ($04), DAC
// strobe ($0C), ADC strobe ($14), PWM control ($1C). Clock clk_ref_i, asynchronous reset. Reset values: both clock
// directions are inputs, so no two ICs can drive the clocks before firmware has chosen a source. The ADC strobe
// commands amplifiers: a trip of the watchdog holds it. servo-ic:2.6, servo-ic:10/10.
`default_nettype none

module servo_ic_regs (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        sel_i,
  input  wire logic        x_i,
  input  wire logic [4:0]  addr_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  input  wire logic        trip_i,            // the watchdog has tripped
  output logic [23:0]      rdata_o,           // 0 when not selected
  output logic [11:0]      clock_dividers_o,  // I7m03, as in the clock control word
  output logic             phase_ext_o,
  output logic             servo_ext_o,
  output logic [3:0]       phase_div_o,
  output logic [3:0]       servo_div_o,
  output logic [23:0]      dac_strobe_o,
  output logic [23:0]      adc_strobe_o,
  output logic [7:0]       deadtime_o,
  output logic [14:0]      max_count_o
);

  localparam logic [4:0] ClockControl = brick_regs_pkg::ServoIcClockControlAddr[4:0];
  localparam logic [4:0] DacStrobe    = brick_regs_pkg::ServoIcDacStrobeAddr[4:0];
  localparam logic [4:0] AdcStrobe    = brick_regs_pkg::ServoIcAdcStrobeAddr[4:0];
  localparam logic [4:0] PwmControl   = brick_regs_pkg::ServoIcPwmControlAddr[4:0];

  logic [23:0] clock_q, dac_strobe_q, adc_strobe_q, pwm_q;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      clock_q      <= brick_regs_pkg::ServoIcClockControlReset;
      dac_strobe_q <= brick_regs_pkg::ServoIcDacStrobeReset;
      adc_strobe_q <= brick_regs_pkg::ServoIcAdcStrobeReset;
      pwm_q        <= brick_regs_pkg::ServoIcPwmControlReset;
    end else if (sel_i && we_i && x_i) begin
      case (addr_i)
        ClockControl: clock_q      <= wdata_i & brick_regs_pkg::ServoIcClockControlWritten;
        DacStrobe:    if (!trip_i) dac_strobe_q <= wdata_i;
        AdcStrobe:    if (!trip_i) adc_strobe_q <= wdata_i;
        PwmControl:   pwm_q        <= wdata_i & brick_regs_pkg::ServoIcPwmControlWritten;
        default: ;
      endcase
    end
  end

  always_comb begin
    rdata_o = 24'h0;
    if (sel_i && x_i) begin
      case (addr_i)
        ClockControl: rdata_o = clock_q;
        DacStrobe:    rdata_o = dac_strobe_q;
        AdcStrobe:    rdata_o = adc_strobe_q;
        PwmControl:   rdata_o = pwm_q;
        default: ;
      endcase
    end
  end

  logic phase_direction, servo_direction;
  assign phase_direction  = clock_q[brick_regs_pkg::ServoIcClockControlPhaseExternalLsb];
  assign servo_direction  = clock_q[brick_regs_pkg::ServoIcClockControlServoExternalLsb];
  assign phase_ext_o      = phase_direction == brick_regs_pkg::ClockDirectionInput;
  assign servo_ext_o      = servo_direction == brick_regs_pkg::ClockDirectionInput;
  assign phase_div_o      = clock_q[brick_regs_pkg::ServoIcClockControlPhaseDividerLsb +: 4];
  assign servo_div_o      = clock_q[brick_regs_pkg::ServoIcClockControlServoDividerLsb +: 4];
  assign clock_dividers_o = clock_q[11:0];
  assign dac_strobe_o     = dac_strobe_q;
  assign adc_strobe_o     = adc_strobe_q;
  assign deadtime_o       = pwm_q[brick_regs_pkg::ServoIcPwmControlDeadtimeLsb +: 8];
  assign max_count_o      = pwm_q[brick_regs_pkg::ServoIcPwmControlMaxCountLsb +: 15];

endmodule : servo_ic_regs

`default_nettype wire
