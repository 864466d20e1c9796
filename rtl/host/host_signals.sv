// Latch of the four signals that the firmware gives to the host: bit 0 IPOS, 1 BREQ, 2 EROR, 3 F1ER (X:$070010).
// Low after reset. Clock clk_ref_i, asynchronous reset. docs/host-bus.md.
`default_nettype none

module host_signals (
  input  wire logic       clk_ref_i,
  input  wire logic       rst_ni,
  input  wire logic       wr_i,     // one clk_ref
  input  wire logic [3:0] wdata_i,
  output logic [3:0]      rdata_o,
  output logic            ipos_o,
  output logic            breq_o,
  output logic            eror_o,
  output logic            f1er_o
);

  logic [3:0] latch_q;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni)   latch_q <= brick_regs_pkg::BoardLatchesHostSignalsReset[3:0];
    else if (wr_i) latch_q <= wdata_i;
  end

  assign rdata_o = latch_q;
  assign ipos_o  = latch_q[brick_regs_pkg::BoardLatchesHostSignalsIposLsb];
  assign breq_o  = latch_q[brick_regs_pkg::BoardLatchesHostSignalsBreqLsb];
  assign eror_o  = latch_q[brick_regs_pkg::BoardLatchesHostSignalsErorLsb];
  assign f1er_o  = latch_q[brick_regs_pkg::BoardLatchesHostSignalsF1erLsb];

endmodule : host_signals

`default_nettype wire
