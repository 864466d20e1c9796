// Memory of the dual-ported RAM: 32768 words of 16 bits, two ports with a clock of their own, one access an edge on
// each. A port writes, or else reads, or does neither; what it read stays until it reads again. No reset, and no more
// than this, so that synthesis makes block RAM of it (tools/area.py maps it and refuses anything else). What two ports
// do to one word at one edge is undefined where one of them writes: the arbitration of dpram.sv keeps that away.
`default_nettype none

module dpram_memory (
  input  wire logic        a_clk_i,
  input  wire logic        a_we_i,
  input  wire logic        a_re_i,
  input  wire logic [14:0] a_addr_i,
  input  wire logic [15:0] a_wdata_i,
  output logic [15:0]      a_rdata_o,
  input  wire logic        b_clk_i,
  input  wire logic [1:0]  b_we_i,  // each byte its own
  input  wire logic        b_re_i,
  input  wire logic [14:0] b_addr_i,
  input  wire logic [15:0] b_wdata_i,
  output logic [15:0]      b_rdata_o
);

  logic [15:0] mem [0:32767];

  // Two plain blocks: what an always_ff writes nobody else may (IEEE 1800, 9.2.2.4), and vendors' tools keep to that.
  always @(posedge a_clk_i) begin
    if (a_we_i)      mem[a_addr_i] <= a_wdata_i;
    else if (a_re_i) a_rdata_o <= mem[a_addr_i];
  end

  always @(posedge b_clk_i) begin
    if (b_we_i[0]) mem[b_addr_i][7:0]  <= b_wdata_i[7:0];
    if (b_we_i[1]) mem[b_addr_i][15:8] <= b_wdata_i[15:8];
    if (b_re_i && b_we_i == 2'b00) b_rdata_o <= mem[b_addr_i];
  end

endmodule : dpram_memory

`default_nettype wire
