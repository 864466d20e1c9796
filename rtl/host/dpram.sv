// Dual-ported RAM, 16 bits wide, with BUSY arbitration. Each side has a port and a clock of its own; the clocks are of
// one phase, so what one side says to the other needs no synchroniser. Word index: CPU {address, X} (Y word even, X
// word odd), host byte offset / 2. The order is that of the sampling edges, ties go to the CPU. The later side of one
// word sees BUSY if one of the two writes, until the earlier one has ended its strobe. Words beyond the fitted size
// read 0 and take no writes. Asynchronous reset, the content is kept. docs/dpram.md, host-bus:6.9.
`default_nettype none

module dpram (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        small_i,      // strap: only the first 8192 words are fitted
  // CPU side: Port A pins and the falls of its strobes (bus_strobes), not yet synchronised
  input  wire logic [1:0]  rd_falls_i,
  input  wire logic [1:0]  wr_falls_i,
  input  wire logic        cpu_sel_i,
  input  wire logic        cpu_x_i,
  input  wire logic [13:0] cpu_addr_i,
  input  wire logic        cpu_rd_ni,
  input  wire logic        cpu_wr_ni,
  input  wire logic [15:0] cpu_wdata_i,
  output logic [15:0]      cpu_rdata_o,
  output logic             cpu_drive_o,  // the word of this read stands; off with /RD, without a clock
  output logic             cpu_wait_o,   // /TA: from the fall of the strobe until the access is done
  output logic             cpu_busy_o,   // waits for the host's access to the same word
  // host side, from isa_slave
  input  wire logic        mem_sel_i,    // a command is under way
  input  wire logic        mem_rd_i,     // 1 read, 0 write
  input  wire logic        mem_wr_i,     // one clk_ref: the write takes place
  input  wire logic [14:0] mem_addr_i,
  input  wire logic [1:0]  mem_be_i,
  input  wire logic [15:0] mem_wdata_i,
  output logic [15:0]      mem_rdata_o,
  output logic             mem_busy_d_o, // the next edge of clk_ref makes the host wait, or lets it wait on
  output logic             host_busy_o   // BUSY pin of the host side: what that said at the last edge
);

  // ---------------------------------------------------------------- CPU side, pins
  // Falls and levels of the strobes pass two flip-flops. Select and address have one, so they are looked at a clock
  // later than the strobe: pins have delays of their own, up to a clock, and what is taken is taken back when the
  // strobe has ended before it acts.
  logic [1:0]  rd2_q, wr2_q, rd3_q, wr3_q;
  logic        rd_low2_q, wr_low2_q, sel_q;
  logic [14:0] pins_q;
  sync2 #(.Width(6)) u_strobe_sync (
    .clk_i (clk_pwm_i), .rst_ni,
    .d_i   ({rd_falls_i, wr_falls_i, ~cpu_rd_ni, ~cpu_wr_ni}),
    .q_o   ({rd2_q, wr2_q, rd_low2_q, wr_low2_q})
  );
  always_ff @(posedge clk_pwm_i) begin
    {rd3_q, wr3_q} <= {rd2_q, wr2_q};
    sel_q          <= cpu_sel_i;
    pins_q         <= {cpu_addr_i, cpu_x_i};
  end

  // ---------------------------------------------------------------- CPU side, arbitration
  // A strobe is a request until its done count has followed: when it is granted, or when it is found, a clock after its
  // fall, to be high again or not for this RAM; level and select may come a clock after the fall. It is granted only
  // while it is seen low. A grant reads at once. A write samples its data there and is made two edges later, if /WR
  // then proves to have been low, and no other strobe to have fallen, up to that sample, a clock after the address'.
  logic [1:0]  rd_done_q, rd_ack_q, wr_done_q;
  logic        busy_q, own_q, own_wr_q, sampled_q, proven_q, show_q;
  logic [14:0] cell_q;
  logic [15:0] wdata_q;
  logic        rd_new, wr_new, rd_low, wr_low, rd_vain, wr_vain, fallen, still;
  logic        request, conflict, blocked, grant, pins_here, cell_here;
  logic        host_own_q, mem_busy_q;
  assign rd_new    = rd2_q != rd_done_q;
  assign wr_new    = wr2_q != wr_done_q;
  assign rd_low    = rd_new & rd_low2_q;
  assign wr_low    = wr_new & wr_low2_q;
  assign rd_vain   = (rd2_q == rd3_q) & ~(sel_q & rd_low2_q);
  assign wr_vain   = (wr2_q == wr3_q) & ~(sel_q & wr_low2_q);
  assign fallen    = rd_new | wr_new;  // so the strobe before has ended, even if it was not seen high
  assign still     = wr_low2_q & ~wr_new;  // the write under way, not a next one
  assign request   = sel_q & (rd_low | wr_low) & ~sampled_q & ~proven_q;
  assign conflict  = (pins_q == mem_addr_i) & (wr_low | ~mem_rd_i);
  assign blocked   = (host_own_q | mem_busy_q) & conflict;  // the host is there, or was first to wait
  assign grant     = request & ~blocked;
  assign pins_here = ~small_i | (pins_q[14:13] == 2'b00);
  assign cell_here = ~small_i | (cell_q[14:13] == 2'b00);

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      rd_done_q  <= 2'd0;
      rd_ack_q   <= 2'd0;
      wr_done_q  <= 2'd0;
      busy_q     <= 1'b0;
      own_q      <= 1'b0;
      show_q     <= 1'b0;
    end else begin
      if (rd_vain || (grant && !wr_low)) rd_done_q <= rd2_q;
      if (wr_vain || grant)              wr_done_q <= wr2_q;
      rd_ack_q   <= rd_done_q;  // a clock after the data: /TA may be sampled later than they are
      busy_q     <= request & blocked;
      if (grant) begin
        own_q <= 1'b1;
        if (!wr_low) show_q <= pins_here;
      end else if (!sampled_q && !proven_q && (fallen || !(own_wr_q ? wr_low2_q : rd_low2_q))) begin
        own_q <= 1'b0;
      end
    end
  end

  // A reset ends the strobes, and with them a write that has been sampled.
  always_ff @(posedge clk_pwm_i) begin
    sampled_q <= grant & wr_low;
    proven_q  <= sampled_q & still;
    if (grant) begin
      own_wr_q <= wr_low;
      cell_q   <= pins_q;
      wdata_q  <= cpu_wdata_i;
    end
  end

  // The pins show a word of this RAM from its grant to the end of /RD, without a clock there, and only of the read that
  // was granted. That it is still low then is what proves its address: a strobe of others that was granted by the next
  // one's address has ended.
  logic       rd_low_n, drive_q;
  logic [1:0] drive_rd_q;
  assign rd_low_n = rst_ni & ~cpu_rd_ni;
  always_ff @(posedge clk_pwm_i or negedge rd_low_n) begin
    if (!rd_low_n)             drive_q <= 1'b0;
    else if (grant && !wr_low) drive_q <= 1'b1;
  end

  always_ff @(posedge clk_pwm_i) begin
    if (grant && !wr_low) drive_rd_q <= rd2_q;
  end

  assign cpu_drive_o = drive_q & (rd_falls_i == drive_rd_q);
  assign cpu_wait_o = cpu_sel_i & ((rd_falls_i != rd_ack_q) | (wr_falls_i != wr_done_q));
  assign cpu_busy_o = busy_q;

  // ---------------------------------------------------------------- host side
  logic        host_show_q, host_blocked, host_grant, host_here, host_we, mem_busy_d;
  assign host_blocked = (own_q & (cell_q == mem_addr_i) & (own_wr_q | ~mem_rd_i)) | (request & conflict & ~mem_busy_q);
  assign host_grant   = mem_sel_i & ~host_own_q & ~host_blocked;
  assign mem_busy_d   = mem_sel_i & ~host_own_q & host_blocked;
  assign host_here    = ~small_i | (mem_addr_i[14:13] == 2'b00);
  assign host_we      = mem_wr_i & host_own_q & host_here;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      host_own_q  <= 1'b0;
      mem_busy_q  <= 1'b0;
      host_show_q <= 1'b0;
    end else begin
      host_own_q <= mem_sel_i & (host_own_q | host_grant);
      mem_busy_q <= mem_busy_d;
      if (host_grant && mem_rd_i) host_show_q <= host_here;
    end
  end

  assign mem_busy_d_o = mem_busy_d;
  assign host_busy_o  = mem_busy_q;

  // ---------------------------------------------------------------- memory
  logic [15:0] cpu_rdata, host_rdata;
  dpram_memory u_memory (
    .a_clk_i   (clk_pwm_i),
    .a_we_i    (proven_q & still & cell_here),
    .a_re_i    (grant & ~wr_low),
    .a_addr_i  (proven_q ? cell_q : pins_q),
    .a_wdata_i (wdata_q),
    .a_rdata_o (cpu_rdata),
    .b_clk_i   (clk_ref_i),
    .b_we_i    ({2{host_we}} & mem_be_i),
    .b_re_i    (host_grant & mem_rd_i),
    .b_addr_i  (mem_addr_i),
    .b_wdata_i (mem_wdata_i),
    .b_rdata_o (host_rdata)
  );
  assign cpu_rdata_o = show_q ? cpu_rdata : 16'h0;
  assign mem_rdata_o = host_show_q ? host_rdata : 16'h0;

endmodule : dpram

`default_nettype wire
