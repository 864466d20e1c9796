// Latch of the four signals that the firmware gives to the host: bit 0 IPOS, 1 BREQ, 2 EROR, 3 F1ER (X:$070010), and
// of the outputs CTRL0 and CTRL1, bits 0 and 1 of a word of their own (X:$070012), so that a user program that writes
// them cannot meet the firmware. Low after reset; CTRL0 and CTRL1 also from a trip of the watchdog to the reset. Clock
// clk_ref_i, asynchronous reset. docs/host_signals.md.
`default_nettype none

module host_signals (
  input  wire logic       clk_ref_i,
  input  wire logic       rst_ni,
  input  wire logic       trip_i,     // of the watchdog: has tripped, or trips at the edge to come
  input  wire logic       wr_i,       // one clk_ref
  input  wire logic       ctrl_wr_i,  // one clk_ref
  input  wire logic [3:0] wdata_i,
  output logic [3:0]      rdata_o,
  output logic [1:0]      ctrl_o,
  output logic            ipos_o,
  output logic            breq_o,
  output logic            eror_o,
  output logic            f1er_o
);

  logic [3:0] latch_q;
  logic [1:0] ctrl_d, ctrl_q;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni)   latch_q <= brick_regs_pkg::BoardLatchesHostSignalsReset[3:0];
    else if (wr_i) latch_q <= wdata_i;
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni)        ctrl_q <= brick_regs_pkg::BoardLatchesControlOutputsReset[1:0];
    else if (trip_i)    ctrl_q <= 2'b00;
    else if (ctrl_wr_i) ctrl_q <= ctrl_d;
  end
  assign ctrl_d = {wdata_i[brick_regs_pkg::BoardLatchesControlOutputsCtrl1Lsb],
                   wdata_i[brick_regs_pkg::BoardLatchesControlOutputsCtrl0Lsb]};

  assign rdata_o = latch_q;
  assign ctrl_o  = ctrl_q;
  assign ipos_o  = latch_q[brick_regs_pkg::BoardLatchesHostSignalsIposLsb];
  assign breq_o  = latch_q[brick_regs_pkg::BoardLatchesHostSignalsBreqLsb];
  assign eror_o  = latch_q[brick_regs_pkg::BoardLatchesHostSignalsErorLsb];
  assign f1er_o  = latch_q[brick_regs_pkg::BoardLatchesHostSignalsF1erLsb];

endmodule : host_signals

`default_nettype wire
