// Registers of one channel: control word, output commands, latched error bits, and the read multiplexer of its eight
// addresses. X:+4 belongs to the IC and reads 0 here. Clock clk_ref_i, asynchronous reset. docs/registers.md,
// servo_channel.
`default_nettype none

module channel_regs (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  // bus: we_i is high for the one clk_ref edge that writes
  input  wire logic        x_i,
  input  wire logic [2:0]  addr_i,
  input  wire logic        sel_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  output logic [23:0]      rdata_o,       // 0 when not selected
  input  wire logic        trip_i,        // commands and what says which level is off ignore writes
  input  wire logic        trip_d_i,      // it trips with the coming edge, or has: AENA does not rise
  // written words
  output logic [23:0]      control_o,
  output logic             aena_o,        // its bit, until a trip that was told
  output logic [23:0]      out_a_o,
  output logic [23:0]      out_b_o,
  output logic [23:0]      out_c_o,
  output logic [5:0]       compare_we_o,  // A, B, increment, fraction of A, fraction of B, EQU
  // read words
  input  wire logic [23:12] level_i,      // inputs, as in the status word
  input  wire logic        error_i,       // this edge sees an illegal transition, an encoder loss
  input  wire logic        loss_i,
  input  wire logic        equ_i,
  input  wire logic        incomplete_i,
  input  wire logic        captured_i,
  input  wire logic        captured_gi_i,
  input  wire logic [2:0]  hall_i,
  input  wire logic [23:0] phase_pos_i,
  input  wire logic [23:0] servo_pos_i,
  input  wire logic [23:0] servo_t1_i,
  input  wire logic [22:0] servo_t2_i,
  input  wire logic [11:0] servo_fraction_i,
  input  wire logic [23:0] capture_pos_i,
  input  wire logic [11:0] capture_fraction_i,
  input  wire logic [17:0] adc_a_i,
  input  wire logic [17:0] adc_b_i,
  input  wire logic [23:0] compare_a_i,
  input  wire logic [23:0] compare_b_i,
  input  wire logic [23:0] compare_inc_i,
  input  wire logic [11:0] a_fraction_i,
  input  wire logic [11:0] b_fraction_i
);

  // Words, {X, place}.
  localparam logic [3:0] Timer1           = {1'b0, brick_regs_pkg::ServoChannelTimer1Addr[2:0]};
  localparam logic [3:0] Timer2           = {1'b0, brick_regs_pkg::ServoChannelTimer2Addr[2:0]};
  localparam logic [3:0] OutA             = {1'b0, brick_regs_pkg::ServoChannelOutAAddr[2:0]};
  localparam logic [3:0] OutB             = {1'b0, brick_regs_pkg::ServoChannelOutBAddr[2:0]};
  localparam logic [3:0] OutC             = {1'b0, brick_regs_pkg::ServoChannelOutCAddr[2:0]};
  localparam logic [3:0] AdcA             = {1'b0, brick_regs_pkg::ServoChannelAdcAAddr[2:0]};
  localparam logic [3:0] AdcB             = {1'b0, brick_regs_pkg::ServoChannelAdcBAddr[2:0]};
  localparam logic [3:0] CompareA         = {1'b0, brick_regs_pkg::ServoChannelCompareAAddr[2:0]};
  localparam logic [3:0] Status           = {1'b1, brick_regs_pkg::ServoChannelStatusAddr[2:0]};
  localparam logic [3:0] PhasePosition    = {1'b1, brick_regs_pkg::ServoChannelPhasePositionAddr[2:0]};
  localparam logic [3:0] ServoPosition    = {1'b1, brick_regs_pkg::ServoChannelServoPositionAddr[2:0]};
  localparam logic [3:0] FlagPosition     = {1'b1, brick_regs_pkg::ServoChannelFlagPositionAddr[2:0]};
  localparam logic [3:0] Control          = {1'b1, brick_regs_pkg::ServoChannelControlAddr[2:0]};
  localparam logic [3:0] CompareIncrement = {1'b1, brick_regs_pkg::ServoChannelCompareIncrementAddr[2:0]};
  localparam logic [3:0] CompareB         = {1'b1, brick_regs_pkg::ServoChannelCompareBAddr[2:0]};
  localparam int         EquWrite         = brick_regs_pkg::ServoChannelControlEquWriteLsb;
  // Bits of the control word that say what the output pins are and which level is off, and the sense of DIR.
  localparam logic [23:0] OutputBits = 24'd1 << brick_regs_pkg::ServoChannelControlPfmDirInvertLsb |
                                       24'd1 << brick_regs_pkg::ServoChannelControlAbInvertLsb |
                                       24'd1 << brick_regs_pkg::ServoChannelControlCInvertLsb |
                                       24'd1 << brick_regs_pkg::ServoChannelControlAbDacLsb |
                                       24'd1 << brick_regs_pkg::ServoChannelControlCPfmLsb;

  logic [23:0] control_q, out_a_q, out_b_q, out_c_q, control_kept;
  logic        aena_q, error_q, loss_q, fine, we_status, we_control;
  assign fine = control_q[brick_regs_pkg::ServoChannelControlHardware1tLsb];

  always_comb begin
    we_status    = 1'b0;
    we_control   = 1'b0;
    compare_we_o = 6'd0;
    if (we_i) begin
      case ({x_i, addr_i})
        Timer1:           compare_we_o[4] = fine;
        Timer2:           compare_we_o[3] = fine;
        CompareA:         compare_we_o[0] = 1'b1;
        CompareB:         compare_we_o[1] = 1'b1;
        CompareIncrement: compare_we_o[2] = 1'b1;
        Status:           we_status       = 1'b1;
        Control: begin
          we_control      = 1'b1;
          compare_we_o[5] = wdata_i[EquWrite];
        end
        default: ;
      endcase
    end
  end

  assign control_kept = trip_i ? OutputBits : 24'd0;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      control_q <= brick_regs_pkg::ServoChannelControlReset;
      out_a_q   <= brick_regs_pkg::ServoChannelOutAReset;
      out_b_q   <= brick_regs_pkg::ServoChannelOutBReset;
      out_c_q   <= brick_regs_pkg::ServoChannelOutCReset;
      aena_q    <= brick_regs_pkg::ServoChannelControlReset[brick_regs_pkg::ServoChannelControlAenaLsb];
      error_q   <= 1'b0;
      loss_q    <= 1'b0;
    end else begin
      if (we_control)               control_q           <= (control_q & control_kept) | (wdata_i & ~control_kept);
      else if (control_q[EquWrite]) control_q[EquWrite] <= 1'b0;  // falls back by itself
      if (trip_d_i)        aena_q <= 1'b0;
      else if (we_control) aena_q <= wdata_i[brick_regs_pkg::ServoChannelControlAenaLsb];
      if (we_i && !trip_i) begin
        if ({x_i, addr_i} == OutA) out_a_q <= wdata_i;
        if ({x_i, addr_i} == OutB) out_b_q <= wdata_i;
        if ({x_i, addr_i} == OutC) out_c_q <= wdata_i;
      end
      // Any write clears the error, a 0 clears the loss; what happens at that edge is not lost.
      if (control_q[brick_regs_pkg::ServoChannelControlCounterResetLsb]) error_q <= 1'b0;
      else if (error_i)                                                  error_q <= 1'b1;
      else if (we_status)                                                error_q <= 1'b0;
      if (loss_i)                                                                         loss_q <= 1'b1;
      else if (we_status && !wdata_i[brick_regs_pkg::ServoChannelStatusEncoderLossLsb])   loss_q <= 1'b0;
    end
  end

  always_comb begin
    rdata_o = 24'd0;
    if (sel_i) begin
      case ({x_i, addr_i})
        OutA:             rdata_o = out_a_q;
        OutB:             rdata_o = out_b_q;
        OutC:             rdata_o = out_c_q;
        CompareA:         rdata_o = compare_a_i;
        PhasePosition:    rdata_o = phase_pos_i;
        ServoPosition:    rdata_o = servo_pos_i;
        FlagPosition:     rdata_o = capture_pos_i;
        Control:          rdata_o = control_q;
        CompareIncrement: rdata_o = compare_inc_i;
        CompareB:         rdata_o = compare_b_i;
        AdcA: rdata_o[brick_regs_pkg::ServoChannelAdcAValueLsb +: brick_regs_pkg::ServoChannelAdcAValueWidth] = adc_a_i;
        AdcB: rdata_o[brick_regs_pkg::ServoChannelAdcBValueLsb +: brick_regs_pkg::ServoChannelAdcBValueWidth] = adc_b_i;
        Timer1: begin
          rdata_o = servo_t1_i;
          if (fine) begin
            rdata_o[brick_regs_pkg::ServoChannelFineTimer1CapturedLsb +: 12] = capture_fraction_i;
            rdata_o[brick_regs_pkg::ServoChannelFineTimer1CompareBLsb +: 12] = b_fraction_i;
          end
        end
        Timer2: begin
          rdata_o[brick_regs_pkg::ServoChannelTimer2T2Lsb +: brick_regs_pkg::ServoChannelTimer2T2Width] = servo_t2_i;
          if (fine) begin
            rdata_o[brick_regs_pkg::ServoChannelFineTimer2ServoLsb +: 12]    = servo_fraction_i;
            rdata_o[brick_regs_pkg::ServoChannelFineTimer2CompareALsb +: 12] = a_fraction_i;
          end
        end
        Status: begin
          rdata_o[23:12] = level_i;
          rdata_o[brick_regs_pkg::ServoChannelStatusCapturedLsb]           = captured_i;
          rdata_o[brick_regs_pkg::ServoChannelStatusCapturedGatedIndexLsb] = captured_gi_i;
          rdata_o[brick_regs_pkg::ServoChannelStatusEquLsb]                = equ_i;
          rdata_o[brick_regs_pkg::ServoChannelStatusEncoderErrorLsb]       = error_q;
          rdata_o[brick_regs_pkg::ServoChannelStatusEncoderLossLsb]        = loss_q;
          rdata_o[brick_regs_pkg::ServoChannelStatusDemuxInvalidLsb]       = incomplete_i;
          rdata_o[brick_regs_pkg::ServoChannelStatusHallCaptureLsb +: 3]   = hall_i;
        end
        default: ;
      endcase
    end
  end

  assign control_o = control_q;
  assign aena_o    = aena_q;
  assign out_a_o   = out_a_q;
  assign out_b_o   = out_b_q;
  assign out_c_o   = out_c_q;

endmodule : channel_regs

`default_nettype wire
