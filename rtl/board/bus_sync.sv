// Port A synchroniser: the CPU's bus pins pass two flip-flops on clk_ref_i. One strobe a write (we_o, with address and
// data of stage 1, at the edge after the one that first saw /WR low), one a read (rd_done_o, at the edge at which /RD
// is seen high again, with the address of stage 2, because the CPU may already show the next one). Asynchronous reset.
// docs/architecture.md.
`default_nettype none

module bus_sync (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic [18:0] pa_addr_i,
  input  wire logic        pa_x_i,
  input  wire logic [3:0]  pa_aa_i,
  input  wire logic        pa_int_i,
  input  wire logic        pa_rd_ni,
  input  wire logic        pa_wr_ni,
  input  wire logic [23:0] pa_wdata_i,
  output logic [18:0]      addr_o,
  output logic             x_o,
  output logic [3:0]       aa_o,
  output logic             int_o,
  output logic [23:0]      wdata_o,
  output logic             we_o,
  output logic             rd_done_o,
  output logic [18:0]      rd_addr_o,
  output logic             rd_x_o,
  output logic [3:0]       rd_aa_o,
  output logic             rd_int_o
);

  logic [24:0] where1_q, where2_q;  // {int, aa, x, addr}
  logic [23:0] wdata1_q;
  logic        rd1_nq, rd2_nq, wr1_nq, wr2_nq;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      where1_q <= 25'h0;
      where2_q <= 25'h0;
      wdata1_q <= 24'h0;
      rd1_nq   <= 1'b1;
      rd2_nq   <= 1'b1;
      wr1_nq   <= 1'b1;
      wr2_nq   <= 1'b1;
    end else begin
      where1_q <= {pa_int_i, pa_aa_i, pa_x_i, pa_addr_i};
      where2_q <= where1_q;
      wdata1_q <= pa_wdata_i;
      rd1_nq   <= pa_rd_ni;
      rd2_nq   <= rd1_nq;
      wr1_nq   <= pa_wr_ni;
      wr2_nq   <= wr1_nq;
    end
  end

  assign {int_o, aa_o, x_o, addr_o}             = where1_q;
  assign {rd_int_o, rd_aa_o, rd_x_o, rd_addr_o} = where2_q;
  assign wdata_o   = wdata1_q;
  assign we_o      = ~wr1_nq & wr2_nq;
  assign rd_done_o = rd1_nq & ~rd2_nq;

endmodule : bus_sync

`default_nettype wire
