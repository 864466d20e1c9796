// Registers of a MACRO IC as far as they are built: clock control (X:+$0C), PWM control (X:+$0D), ADC strobe (X:+$0E),
// ring control (X:+$0F) and node activation (Y:+$0F), JIO and multiplexer port data (Y:+$00, Y:+$02), and the control
// words of the supplementary channels (X:+$15, X:+$1D). All but the first two are storage. A MACROGATE (gate_i) has a
// direction bit for PHASE only and no supplementary channels. Clock clk_ref_i, asynchronous reset: both clocks are
// inputs. docs/macro_ic.md.
`default_nettype none

module macro_ic_regs (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        gate_i,            // 1 = MACROGATE, 0 = DSPGATE2
  input  wire logic        sel_i,
  input  wire logic        x_i,
  input  wire logic [5:0]  addr_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  output logic [23:0]      rdata_o,           // 0 when not selected
  output logic             phase_ext_o,
  output logic             servo_ext_o,       // a MACROGATE has no servo clock to drive
  output logic [3:0]       phase_div_o,
  output logic [3:0]       servo_div_o,
  output logic [14:0]      max_count_o
);

  localparam int ServoExternal = brick_regs_pkg::MacroIcClockControlServoExternalLsb;
  // Places of the words, X and Y.
  localparam logic [5:0] ClockControl    = 6'(brick_regs_pkg::MacroIcClockControlAddr);
  localparam logic [5:0] PwmControl      = 6'(brick_regs_pkg::MacroIcPwmControlAddr);
  localparam logic [5:0] AdcStrobe       = 6'(brick_regs_pkg::MacroIcAdcStrobeAddr);
  localparam logic [5:0] RingControl     = 6'(brick_regs_pkg::MacroIcRingControlAddr);
  localparam logic [5:0] Supplementary1  = 6'(brick_regs_pkg::MacroIcSupplementary1Addr);
  localparam logic [5:0] Supplementary2  = 6'(brick_regs_pkg::MacroIcSupplementary2Addr);
  localparam logic [5:0] JioData         = 6'(brick_regs_pkg::MacroIcJioDataAddr);
  localparam logic [5:0] MultiplexerData = 6'(brick_regs_pkg::MacroIcMultiplexerDataAddr);
  localparam logic [5:0] NodeActivation  = 6'(brick_regs_pkg::MacroIcNodeActivationAddr);

  logic [23:0] clock_q, pwm_q, adc_strobe_q, ring_q, nodes_q, jio_q, multiplexer_q, channel_1_q, channel_2_q;

  logic write_x, write_y;
  assign write_x = sel_i & we_i & x_i;
  assign write_y = sel_i & we_i & ~x_i;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      clock_q       <= brick_regs_pkg::MacroIcClockControlReset;
      pwm_q         <= brick_regs_pkg::MacroIcPwmControlReset;
      adc_strobe_q  <= brick_regs_pkg::MacroIcAdcStrobeReset;
      ring_q        <= brick_regs_pkg::MacroIcRingControlReset;
      nodes_q       <= brick_regs_pkg::MacroIcNodeActivationReset;
      jio_q         <= brick_regs_pkg::MacroIcJioDataReset;
      multiplexer_q <= brick_regs_pkg::MacroIcMultiplexerDataReset;
      channel_1_q   <= brick_regs_pkg::MacroIcSupplementary1Reset;
      channel_2_q   <= brick_regs_pkg::MacroIcSupplementary2Reset;
    end else if (write_x) begin
      case (addr_i)
        ClockControl:   clock_q      <= wdata_i & brick_regs_pkg::MacroIcClockControlWritten;
        PwmControl:     pwm_q        <= wdata_i & brick_regs_pkg::MacroIcPwmControlWritten;
        AdcStrobe:      adc_strobe_q <= wdata_i;
        RingControl:    ring_q       <= wdata_i;
        Supplementary1: channel_1_q  <= wdata_i & brick_regs_pkg::MacroIcSupplementary1Written;
        Supplementary2: channel_2_q  <= wdata_i & brick_regs_pkg::MacroIcSupplementary2Written;
        default: ;
      endcase
    end else if (write_y) begin
      case (addr_i)
        JioData:         jio_q         <= wdata_i;
        MultiplexerData: multiplexer_q <= wdata_i;
        NodeActivation:  nodes_q       <= wdata_i;
        default: ;
      endcase
    end
  end

  always_comb begin
    rdata_o = 24'h0;
    if (sel_i && x_i) begin
      case (addr_i)
        ClockControl:   rdata_o = clock_q & ~({23'h0, gate_i} << ServoExternal);
        PwmControl:     rdata_o = pwm_q;
        AdcStrobe:      rdata_o = adc_strobe_q;
        RingControl:    rdata_o = ring_q;
        Supplementary1: rdata_o = gate_i ? 24'h0 : channel_1_q;
        Supplementary2: rdata_o = gate_i ? 24'h0 : channel_2_q;
        default:        rdata_o = 24'h0;
      endcase
    end else if (sel_i) begin
      case (addr_i)
        JioData:         rdata_o = jio_q;
        MultiplexerData: rdata_o = multiplexer_q;
        NodeActivation:  rdata_o = nodes_q;
        default:         rdata_o = 24'h0;
      endcase
    end
  end

  logic phase_direction, servo_direction;
  assign phase_direction = clock_q[brick_regs_pkg::MacroIcClockControlPhaseExternalLsb];
  assign servo_direction = clock_q[ServoExternal];
  assign phase_ext_o     = phase_direction == brick_regs_pkg::ClockDirectionInput;
  assign servo_ext_o     = servo_direction == brick_regs_pkg::ClockDirectionInput | gate_i;
  assign phase_div_o     = clock_q[brick_regs_pkg::MacroIcClockControlPhaseDividerLsb +: 4];
  assign servo_div_o     = clock_q[brick_regs_pkg::MacroIcClockControlServoDividerLsb +: 4];
  assign max_count_o     = pwm_q[brick_regs_pkg::MacroIcPwmControlMaxCountLsb +: 15];

endmodule : macro_ic_regs

`default_nettype wire
