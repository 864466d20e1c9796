// The dual-ported RAM with the flip-flops that its CPU's strobes clock, as board_top joins them: what its component
// simulates. start_i, read once when the simulation begins, is what it holds at power-on; peek_o shows any word without
// a port. docs/components.md.
`default_nettype none

module dpram_pins (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        small_i,
  input  wire logic        cpu_sel_i,
  input  wire logic        cpu_x_i,
  input  wire logic [13:0] cpu_addr_i,
  input  wire logic        cpu_rd_ni,
  input  wire logic        cpu_wr_ni,
  input  wire logic [15:0] cpu_wdata_i,
  output logic [15:0]      cpu_rdata_o,
  output logic             cpu_wait_o,
  output logic             cpu_busy_o,
  input  wire logic        mem_sel_i,
  input  wire logic        mem_rd_i,
  input  wire logic        mem_wr_i,
  input  wire logic [14:0] mem_addr_i,
  input  wire logic [1:0]  mem_be_i,
  input  wire logic [15:0] mem_wdata_i,
  output logic [15:0]      mem_rdata_o,
  output logic             host_busy_o,
  input  wire logic [15:0] start_i[32768],
  input  wire logic [14:0] peek_addr_i,
  output logic [15:0]      peek_o
);

  logic [1:0] rd_falls, wr_falls;
  logic       unused_drive, unused_busy;

  bus_strobes u_bus_strobes (
    .rst_ni, .pa_rd_ni(cpu_rd_ni), .pa_wr_ni(cpu_wr_ni),
    .rd_falls_o(rd_falls), .wr_falls_o(wr_falls)
  );
  dpram u_dpram (
    .clk_pwm_i, .clk_ref_i, .rst_ni, .small_i,
    .rd_falls_i(rd_falls), .wr_falls_i(wr_falls),
    .cpu_sel_i, .cpu_x_i, .cpu_addr_i, .cpu_rd_ni, .cpu_wr_ni, .cpu_wdata_i,
    .cpu_rdata_o, .cpu_drive_o(unused_drive), .cpu_wait_o, .cpu_busy_o,
    .mem_sel_i, .mem_rd_i, .mem_wr_i, .mem_addr_i, .mem_be_i, .mem_wdata_i,
    .mem_rdata_o, .mem_busy_d_o(unused_busy), .host_busy_o
  );

  initial begin
    for (int i = 0; i < 32768; i++) u_dpram.u_memory.mem[i] = start_i[i];
  end
  assign peek_o = u_dpram.u_memory.mem[peek_addr_i];

endmodule : dpram_pins

`default_nettype wire
