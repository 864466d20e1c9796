// Interrupt controller between the board's eight signal lines and the one interrupt of the host bus. Registers
// (addr_i): 0 read IST, write clears the latches; 1 SIG; 2 MSK, 1 = enabled; 3 ELR, 0 = rising edge, 1 = level. IST =
// MSK & (ELR ? line : latch); any IST is a request to host_interrupt. A latch is set by a rising edge while enabled and
// edge-sensed, and cleared by a write to 0 or while masked; a coincident edge wins over the clear. Lines pass two
// flip-flops: a level of one clock is seen for sure, and an edge raises IRQ at the third clock. Clock clk_ref_i,
// asynchronous reset; reset_i, the host's RESETDRV, clears the registers.
// docs/interrupt_controller.md.
`default_nettype none

module interrupt_controller (
  input  wire logic       clk_ref_i,
  input  wire logic       rst_ni,
  input  wire logic       reset_i,
  input  wire logic [7:0] line_i,
  input  wire logic       wr_i,
  input  wire logic [1:0] addr_i,
  input  wire logic [7:0] wdata_i,
  output logic [7:0]      rdata_o,
  output logic [7:0]      ist_o,
  output logic [7:0]      sig_o,
  output logic [7:0]      msk_o,
  output logic [7:0]      elr_o,
  output logic            request_o,  // any IST, after the coming edge; a level line a clock later
  output logic            served_o    // the latches are cleared
);

  localparam logic [1:0] AddrStatus    = brick_regs_pkg::HostIoPicStatusAddr[1:0];
  localparam logic [1:0] AddrSignal    = brick_regs_pkg::HostIoPicSignalAddr[1:0];
  localparam logic [1:0] AddrMask      = brick_regs_pkg::HostIoPicMaskAddr[1:0];
  localparam logic [1:0] AddrEdgeLevel = brick_regs_pkg::HostIoPicEdgeLevelAddr[1:0];

  logic [7:0] line2_q, line3_q;  // behind the synchroniser, and that one clock ago, for the edge
  logic [7:0] msk_d, msk_q, elr_d, elr_q, latch_d, latch_q, rise;
  logic       clear;

  sync2 #(.Width(8)) u_line_sync (.clk_i(clk_ref_i), .rst_ni, .d_i(line_i), .q_o(line2_q));
  assign rise    = line2_q & ~line3_q;
  assign clear   = wr_i & (addr_i == AddrStatus);

  always_comb begin
    latch_d = (rise & msk_q & ~elr_q) | (latch_q & msk_q & ~{8{clear}});
    msk_d   = (wr_i && addr_i == AddrMask) ? wdata_i : msk_q;
    elr_d   = (wr_i && addr_i == AddrEdgeLevel) ? wdata_i : elr_q;
    if (reset_i) begin
      latch_d = 8'h00;
      msk_d   = brick_regs_pkg::HostIoPicMaskReset;
      elr_d   = brick_regs_pkg::HostIoPicEdgeLevelReset;
    end
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      line3_q <= 8'h00;
      latch_q <= 8'h00;
      msk_q   <= brick_regs_pkg::HostIoPicMaskReset;
      elr_q   <= brick_regs_pkg::HostIoPicEdgeLevelReset;
    end else begin
      line3_q <= line2_q;
      latch_q <= latch_d;
      msk_q   <= msk_d;
      elr_q   <= elr_d;
    end
  end

  assign sig_o = line2_q;
  assign msk_o = msk_q;
  assign elr_o = elr_q;
  assign ist_o = msk_q & ((elr_q & line2_q) | (~elr_q & latch_q));

  assign request_o = |(msk_d & ((elr_d & line2_q) | (~elr_d & latch_d)));
  assign served_o  = clear;

  always_comb begin
    unique case (addr_i)
      AddrStatus: rdata_o = ist_o;
      AddrSignal: rdata_o = sig_o;
      AddrMask:   rdata_o = msk_q;
      default:    rdata_o = elr_q;
    endcase
  end

endmodule : interrupt_controller

`default_nettype wire
