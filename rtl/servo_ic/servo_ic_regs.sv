// The four registers that serve a whole servo IC, in the X word at offset 4 of each channel: clock control ($04), DAC strobe
// ($0C), ADC strobe ($14), PWM control ($1C). Clock clk_ref_i, asynchronous reset. Reset values: both clock directions are
// inputs, so no two ICs can drive the clocks before firmware has chosen a source. servo-ic:2.6.
`default_nettype none

module servo_ic_regs (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        sel_i,
  input  wire logic        x_i,
  input  wire logic [4:0]  addr_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  output logic [23:0]      rdata_o,        // 0 when not selected
  output logic [11:0]      clock_dividers_o,  // I7m03: SCLK, PFM_CLK, DAC_CLK, ADC_CLK
  output logic             phase_ext_o,
  output logic             servo_ext_o,
  output logic [3:0]       phase_div_o,
  output logic [3:0]       servo_div_o,
  output logic [23:0]      dac_strobe_o,
  output logic [23:0]      adc_strobe_o,
  output logic [7:0]       deadtime_o,
  output logic [14:0]      max_count_o
);

  logic [23:0] clock_q, dac_strobe_q, adc_strobe_q, pwm_q;

  localparam int PhaseExternal = brick_regs_pkg::ServoIcClockControlPhaseExternalLsb;
  localparam int ServoExternal = brick_regs_pkg::ServoIcClockControlServoExternalLsb;
  localparam int PhaseDivider  = brick_regs_pkg::ServoIcClockControlPhaseDividerLsb;
  localparam int ServoDivider  = brick_regs_pkg::ServoIcClockControlServoDividerLsb;
  localparam int SclkDivider   = brick_regs_pkg::ServoIcClockControlSclkDividerLsb;  // the first of four fields of three bits
  localparam int Deadtime      = brick_regs_pkg::ServoIcPwmControlDeadtimeLsb;
  localparam int MaxCount      = brick_regs_pkg::ServoIcPwmControlMaxCountLsb;

  logic global_reg;
  assign global_reg = sel_i & x_i & (addr_i[2:0] == 3'd4);

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      clock_q      <= brick_regs_pkg::ServoIcClockControlReset;
      dac_strobe_q <= brick_regs_pkg::ServoIcDacStrobeReset;
      adc_strobe_q <= brick_regs_pkg::ServoIcAdcStrobeReset;
      pwm_q        <= brick_regs_pkg::ServoIcPwmControlReset;
    end else if (we_i && global_reg) begin
      case (addr_i[4:3])
        2'd0:    clock_q      <= wdata_i & brick_regs_pkg::ServoIcClockControlWritten;
        2'd1:    dac_strobe_q <= wdata_i;
        2'd2:    adc_strobe_q <= wdata_i;
        default: pwm_q        <= wdata_i & brick_regs_pkg::ServoIcPwmControlWritten;
      endcase
    end
  end

  always_comb begin
    rdata_o = 24'h0;
    if (global_reg) begin
      case (addr_i[4:3])
        2'd0:    rdata_o = clock_q;
        2'd1:    rdata_o = dac_strobe_q;
        2'd2:    rdata_o = adc_strobe_q;
        default: rdata_o = pwm_q;
      endcase
    end
  end

  assign clock_dividers_o = clock_q[SclkDivider+:12];
  assign phase_ext_o      = clock_q[PhaseExternal];
  assign servo_ext_o      = clock_q[ServoExternal];
  assign phase_div_o      = clock_q[PhaseDivider+:4];
  assign servo_div_o      = clock_q[ServoDivider+:4];
  assign dac_strobe_o     = dac_strobe_q;
  assign adc_strobe_o     = adc_strobe_q;
  assign deadtime_o       = pwm_q[Deadtime+:8];
  assign max_count_o      = pwm_q[MaxCount+:15];
  logic unused_bits;
  assign unused_bits = &{1'b0, clock_q[15:14], pwm_q[23]};

endmodule : servo_ic_regs

`default_nettype wire
