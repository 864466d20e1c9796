// ISA / PC104 slave: sixteen I/O bytes at IoBase (AEN must be 0) and a 64 KiB memory window of 16 bits at MemPage.
// Commands pass two flip-flops on clk_ref_i. With s1 the first and s2 the second stage, the start of a command is the
// edge at which s1 is low and s2 still high: the address is taken and I/O read data loaded. Its end is the edge at
// which s1 is high and s2 still low: a write takes place with the data sampled while the command was last seen low, and
// a read's side effect too. I/O: +0..7 host port, +8..11 interrupt controller, +12..15 read 0xFF. IOCHRDY falls while
// the dual-ported RAM is busy. Byte lanes: SBHE# and SA0; an odd byte with SBHE# high is moved to the low lane (8-bit
// host). Clock clk_ref_i, asynchronous reset. docs/host-bus.md.
`default_nettype none

module isa_slave #(
  parameter logic [15:0] IoBase    = brick_regs_pkg::HostIoBase[15:0],
  parameter logic [3:0]  MemPage   = brick_regs_pkg::DpramWindowBase[19:16],
  parameter logic        DecodeAll = 1'b1  // 0: classic ten-bit I/O decode
) (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic [19:0] isa_sa_i,
  input  wire logic [15:0] isa_sd_i,
  input  wire logic        isa_ior_ni,
  input  wire logic        isa_iow_ni,
  input  wire logic        isa_memr_ni,
  input  wire logic        isa_memw_ni,
  input  wire logic        isa_aen_i,
  input  wire logic        isa_sbhe_ni,
  output logic [15:0]      isa_sd_o,
  output logic             isa_iochrdy_o,
  output logic             isa_memcs16_no,
  // host port
  output logic             hp_sel_o,
  output logic             hp_rd_done_o,
  output logic             hp_wr_o,
  output logic [2:0]       hp_addr_o,
  output logic [7:0]       hp_wdata_o,
  input  wire logic [7:0]  hp_rdata_i,
  // interrupt controller
  output logic             pic_sel_o,
  output logic             pic_wr_o,
  output logic             pic_rd_o,     // one clk_ref, at the edge that takes pic_rdata_i: reads may have effects
  output logic [1:0]       pic_addr_o,
  output logic [7:0]       pic_wdata_o,
  input  wire logic [7:0]  pic_rdata_i,
  // dual-ported RAM
  output logic             mem_sel_o,
  output logic             mem_rd_o,     // 1 read, 0 write
  output logic             mem_wr_o,     // one clk_ref at the end of a write
  output logic [14:0]      mem_addr_o,
  output logic [1:0]       mem_be_o,
  output logic [15:0]      mem_wdata_o,
  input  wire logic [15:0] mem_rdata_i,
  input  wire logic        mem_busy_i
);

  // ---------------------------------------------------------------- synchroniser
  // Commands are kept as 1 = active: {MEMW, MEMR, IOW, IOR}.
  logic [3:0]  cmd1_q, cmd2_q;
  logic [19:0] sa1_q;
  logic [15:0] sd1_q, sd2_q;
  logic        aen1_q, sbhe1_nq, start, finish, idle2;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      cmd1_q   <= 4'h0;
      cmd2_q   <= 4'h0;
      sa1_q    <= 20'h0;
      sd1_q    <= 16'h0;
      sd2_q    <= 16'h0;
      aen1_q   <= 1'b0;
      sbhe1_nq <= 1'b1;
    end else begin
      cmd1_q   <= ~{isa_memw_ni, isa_memr_ni, isa_iow_ni, isa_ior_ni};
      cmd2_q   <= cmd1_q;
      sa1_q    <= isa_sa_i;
      sd1_q    <= isa_sd_i;
      sd2_q    <= sd1_q;
      aen1_q   <= isa_aen_i;
      sbhe1_nq <= isa_sbhe_ni;
    end
  end

  assign idle2  = cmd2_q == 4'h0;
  assign start  = (cmd1_q != 4'h0) & idle2;
  assign finish = (cmd1_q == 4'h0) & ~idle2;

  // ---------------------------------------------------------------- decoding, at the start
  logic       io_hit, mem_hit, port_hit, pic_hit, byte8;
  logic [3:0] target, target_q;  // {memory, reserved, interrupt controller, host port}
  assign io_hit   = (cmd1_q[1] | cmd1_q[0]) & ~aen1_q & (sa1_q[9:4] == IoBase[9:4]) &
                    (~DecodeAll | (sa1_q[15:10] == IoBase[15:10]));
  assign port_hit = sa1_q[3] == brick_regs_pkg::HostIoIcrAddr[3];             // +0..7
  assign pic_hit  = sa1_q[3:2] == brick_regs_pkg::HostIoPicStatusAddr[3:2];  // +8..11
  assign mem_hit  = (cmd1_q[3] | cmd1_q[2]) & (sa1_q[19:16] == MemPage);
  assign byte8    = sbhe1_nq & sa1_q[0];
  assign target   = start ? {mem_hit, io_hit & ~port_hit & ~pic_hit, io_hit & pic_hit, io_hit & port_hit} : target_q;

  logic [15:0] addr_q;
  logic [1:0]  be_q;
  logic        byte8_q, load_q, load_d;
  // Memory data comes at the next edge that is not busy.
  assign load_d = start ? mem_hit & cmd1_q[2] : load_q & mem_busy_i & ~finish;

  logic [15:0] sd_d, sd_q;
  always_comb begin
    sd_d = sd_q;
    if (start && cmd1_q[0] && (target[2:0] != 3'b000)) begin
      sd_d = {8'hFF, target[0] ? hp_rdata_i : (target[1] ? pic_rdata_i : 8'hFF)};
    end else if (load_q && !mem_busy_i) begin
      sd_d = byte8_q ? {mem_rdata_i[15:8], mem_rdata_i[15:8]} : mem_rdata_i;
    end
  end

  logic memcs16_nq;
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      target_q   <= 4'h0;
      addr_q     <= 16'h0;
      be_q       <= 2'b00;
      byte8_q    <= 1'b0;
      load_q     <= 1'b0;
      sd_q       <= 16'hFFFF;
      memcs16_nq <= 1'b1;
    end else begin
      memcs16_nq <= sa1_q[19:16] != MemPage;
      load_q     <= load_d;
      sd_q       <= sd_d;
      if (start) begin
        target_q <= target;
        addr_q   <= sa1_q[15:0];
        be_q     <= byte8 ? 2'b10 : {~sbhe1_nq, ~sa1_q[0]};
        byte8_q  <= byte8;
      end else if (finish) begin
        target_q <= 4'h0;
      end
    end
  end

  // ---------------------------------------------------------------- towards the blocks
  logic [15:0] addr;
  assign addr = start ? sa1_q[15:0] : addr_q;

  assign hp_sel_o     = target[0];
  assign hp_rd_done_o = target[0] & finish & cmd2_q[0];
  assign hp_wr_o      = target[0] & finish & cmd2_q[1];
  assign hp_addr_o    = addr[2:0];
  assign hp_wdata_o   = sd2_q[7:0];

  assign pic_sel_o   = target[1];
  assign pic_wr_o    = target[1] & finish & cmd2_q[1];
  assign pic_rd_o    = target[1] & start & cmd1_q[0];
  assign pic_addr_o  = addr[1:0];
  assign pic_wdata_o = sd2_q[7:0];

  assign mem_sel_o   = target[3] & ~finish;
  assign mem_rd_o    = start ? cmd1_q[2] : cmd2_q[2];
  assign mem_wr_o    = target[3] & finish & cmd2_q[3];
  assign mem_addr_o  = addr[15:1];
  assign mem_be_o    = be_q;
  assign mem_wdata_o = byte8_q ? {sd2_q[7:0], sd2_q[7:0]} : sd2_q;

  assign isa_sd_o       = sd_q;
  assign isa_iochrdy_o  = ~mem_busy_i;
  assign isa_memcs16_no = memcs16_nq;

endmodule : isa_slave

`default_nettype wire
