// Dual-ported RAM, 16 bits wide, with BUSY arbitration. The CPU side works on clk_pwm_i (data two edges after the edge
// that first saw the strobe), the host side on clk_ref_i; the clocks are of one phase, so no synchroniser stands
// between. Word index: CPU {address, X} (Y word even, X word odd), host byte offset / 2. A side owns its cell from the
// edge that granted it to the end of its strobe. Same cell and at least one write: the later side sees BUSY and waits;
// requests that meet at one edge go to the CPU. A CPU strobe that ends while BUSY does nothing. Words beyond the fitted
// size read 0 and take no writes. Asynchronous reset, the content is kept. docs/dpram.md.
`default_nettype none

module dpram (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        small_i,      // strap: only the first 8192 words are fitted
  // CPU side: Port A pins, not yet synchronised
  input  wire logic        cpu_sel_i,
  input  wire logic        cpu_x_i,
  input  wire logic [13:0] cpu_addr_i,
  input  wire logic        cpu_rd_ni,
  input  wire logic        cpu_wr_ni,
  input  wire logic [15:0] cpu_wdata_i,
  output logic [15:0]      cpu_rdata_o,
  output logic             cpu_busy_o,
  // host side, from isa_slave
  input  wire logic        mem_sel_i,    // a command is under way
  input  wire logic        mem_rd_i,     // 1 read, 0 write
  input  wire logic        mem_wr_i,     // one clk_ref: the write takes place
  input  wire logic [14:0] mem_addr_i,
  input  wire logic [1:0]  mem_be_i,
  input  wire logic [15:0] mem_wdata_i,
  output logic [15:0]      mem_rdata_o,
  output logic             mem_busy_o,
  output logic             host_busy_o   // BUSY pin of the host side
);

  logic [15:0] mem [0:32767];

  // ---------------------------------------------------------------- CPU side
  logic        cpu_rd_q, cpu_wr_q, cpu_done_q, cpu_busy_q, host_own_q;
  logic [14:0] cpu_cell_q;
  logic [15:0] cpu_rdata_q;
  logic        cpu_active, same_cell, any_write, cpu_blocked, cpu_grant, cpu_here, host_here, host_we;

  assign cpu_active  = cpu_rd_q | cpu_wr_q;
  assign same_cell   = cpu_cell_q == mem_addr_i;
  assign any_write   = cpu_wr_q | ~mem_rd_i;
  assign cpu_blocked = host_own_q & same_cell & any_write;
  assign cpu_grant   = cpu_active & ~cpu_done_q & ~cpu_blocked;
  assign cpu_here    = ~small_i | (cpu_cell_q[14:13] == 2'b00);
  assign host_here   = ~small_i | (mem_addr_i[14:13] == 2'b00);

  // mem_wr_i lasts three ticks, so the same word is written three times; nobody can see that, the host owns the cell.
  assign host_we = mem_wr_i & host_own_q & host_here;

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      cpu_rd_q    <= 1'b0;
      cpu_wr_q    <= 1'b0;
      cpu_done_q  <= 1'b0;
      cpu_busy_q  <= 1'b0;
      cpu_cell_q  <= 15'h0;
      cpu_rdata_q <= 16'h0;
    end else begin
      cpu_rd_q <= cpu_sel_i & ~cpu_rd_ni;
      cpu_wr_q <= cpu_sel_i & ~cpu_wr_ni;
      if (cpu_active) begin
        if (!cpu_done_q) cpu_busy_q <= cpu_blocked;
        if (cpu_grant)   cpu_done_q <= 1'b1;
        if (cpu_grant && cpu_rd_q) cpu_rdata_q <= cpu_here ? mem[cpu_cell_q] : 16'h0;
      end else begin
        cpu_done_q <= 1'b0;
        cpu_busy_q <= 1'b0;
        cpu_cell_q <= {cpu_addr_i, cpu_x_i};  // held while the strobe is low
      end
    end
  end

  // Two write ports. The CPU's data is taken from the pins at the granting edge, when it has been valid for a tick.
  always_ff @(posedge clk_pwm_i) begin
    if (cpu_grant && cpu_wr_q && cpu_here) mem[cpu_cell_q] <= cpu_wdata_i;
    if (host_we && mem_be_i[0]) mem[mem_addr_i][7:0]  <= mem_wdata_i[7:0];
    if (host_we && mem_be_i[1]) mem[mem_addr_i][15:8] <= mem_wdata_i[15:8];
  end

  assign cpu_rdata_o = cpu_rdata_q;
  assign cpu_busy_o  = cpu_busy_q;

  // ---------------------------------------------------------------- host side
  logic [15:0] mem_rdata_q;
  logic        mem_busy_q, host_blocked;
  assign host_blocked = cpu_active & same_cell & any_write;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      host_own_q  <= 1'b0;
      mem_busy_q  <= 1'b0;
      mem_rdata_q <= 16'h0;
    end else if (!mem_sel_i) begin
      host_own_q <= 1'b0;
      mem_busy_q <= 1'b0;
    end else if (!host_own_q) begin
      host_own_q <= ~host_blocked;
      mem_busy_q <= host_blocked;
      if (!host_blocked && mem_rd_i) mem_rdata_q <= host_here ? mem[mem_addr_i] : 16'h0;
    end
  end

  assign mem_rdata_o = mem_rdata_q;
  assign mem_busy_o  = mem_busy_q;
  assign host_busy_o = mem_busy_q;

endmodule : dpram

`default_nettype wire
