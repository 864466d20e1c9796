// ISA / PC104 slave: sixteen I/O bytes and the window of the dual-ported RAM. Commands pass two flip-flops on
// clk_pwm_i, and clk_ref_i works with what comes out; addresses and data are sampled all the time and used where the
// bus promises that they stand (host-bus:3.4). A cycle starts at the clk_ref edge that finds a command low, I/O data or
// the request to the RAM follows one edge later. It ends at the edge that finds no command: writes, with the data of
// the last clk_pwm edge that saw the command low, and side effects of reads follow one edge later. Two commands at
// once, or one that was low at a reset, do nothing. The data bus is driven in a read of ours alone and let go with the
// command, without a clock. IOCHRDY and MEMCS16# are open collector: 0 pulls, 1 lets go. Asynchronous reset, of what
// shows at a port; RESETDRV resets what stands behind this bus (host_reset_o). docs/isa_slave.md.
`default_nettype none

module isa_slave (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic [6:0]  isa_la_i,    // LA[23:17]
  input  wire logic [19:0] isa_sa_i,
  input  wire logic [15:0] isa_sd_i,
  input  wire logic        isa_ior_ni,
  input  wire logic        isa_iow_ni,
  input  wire logic        isa_memr_ni,
  input  wire logic        isa_memw_ni,
  input  wire logic        isa_aen_i,
  input  wire logic        isa_sbhe_ni,
  input  wire logic        isa_resetdrv_i,
  output logic [15:0]      isa_sd_o,
  output logic [1:0]       isa_sd_oe_o,  // SD[15:8], SD[7:0]
  output logic             isa_iochrdy_o,
  output logic             isa_memcs16_no,
  // switches and set-up, taken over on clk_ref_i
  input  wire logic [7:0]  io_base_i,      // A11..A4 of the I/O block
  input  wire logic        io_decode16_i,  // 0: SA[15:10] are not compared
  input  wire logic [9:0]  window_i,       // A23..A14 of the memory window
  input  wire logic        window_flat_i,  // 1: 64 KiB, 0: 16 KiB, whose page is the register at +12
  input  wire logic        slot8_i,        // no LA: A23..A20 are not compared, A19..A17 come from SA
  output logic             host_reset_o,   // RESETDRV, synchronised
  // host port
  output logic             hp_sel_o,
  output logic             hp_rd_o,        // one clk_ref, at the edge that takes hp_rdata_i
  output logic             hp_rd_done_o,   // one clk_ref at the end of a read that showed data
  output logic             hp_wr_o,        // one clk_ref at the end of a write
  output logic [2:0]       hp_addr_o,
  output logic [7:0]       hp_wdata_o,
  input  wire logic [7:0]  hp_rdata_i,
  // interrupt controller
  output logic             pic_sel_o,
  output logic             pic_rd_o,       // one clk_ref, at the edge that takes pic_rdata_i: reads may have effects
  output logic             pic_wr_o,
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
  input  wire logic [15:0] mem_rdata_i,  // from the clk_ref edge on that lets the host have the word
  input  wire logic        mem_busy_d_i  // at an edge of clk_ref with mem_sel_o: the host waits behind it
);

  // Commands are kept as 1 = active.
  localparam integer Ior = 0, Iow = 1, Memr = 2, Memw = 3;
  // What a cycle is for.
  localparam integer Port = 0, Pic = 1, Other = 2, Memory = 3;

  // ---------------------------------------------------------------- clk_pwm: synchroniser, samples of LA and data
  // A reset leaves the synchroniser active: a command that is low then is part of a cycle that nobody knows.
  logic [3:0]  cmd2_q;
  logic [15:0] sd2_q;
  logic [6:0]  la2_q;
  logic [15:0] sd_low_q;  // the last with a write command low
  logic [6:0]  la;
  // The youngest is MEMCS16#, the oldest belongs to the time before the command: LA may go with it. In a slot of 8 bits
  // the second is taken, as SA may be late (host-bus:3.4/18) and stands: two edges before the command at most.
  logic [3:0]  la_hit_q;
  logic        la_hit;
  logic [7:0]  io_base_q;
  logic [9:0]  window_q;
  logic        io_decode16_q, window_flat_q, slot8_q;

  assign la     = slot8_q ? {4'h0, isa_sa_i[19:17]} : isa_la_i;
  sync2 #(.Width(27), .Reset({4'hF, 23'h0})) u_pin_sync (
    .clk_i (clk_pwm_i), .rst_ni,
    .d_i   ({~{isa_memw_ni, isa_memr_ni, isa_iow_ni, isa_ior_ni}, isa_sd_i, la}),
    .q_o   ({cmd2_q, sd2_q, la2_q})
  );
  assign la_hit = (la2_q[2:0] == window_q[5:3]) & (slot8_q | (la2_q[6:3] == window_q[9:6]));

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) la_hit_q <= 4'h0;
    else         la_hit_q <= {la_hit_q[2:0], la_hit};
  end

  always_ff @(posedge clk_pwm_i) begin
    if (cmd2_q[Iow] | cmd2_q[Memw]) sd_low_q <= sd2_q;
  end

  // ---------------------------------------------------------------- clk_ref: address, switches, RESETDRV
  logic [16:0] sa_q;
  logic        aen_q, sbhe_nq;
  logic        resetdrv;
  sync2 u_resetdrv_sync (.clk_i(clk_ref_i), .rst_ni, .d_i(isa_resetdrv_i), .q_o(resetdrv));
  always_ff @(posedge clk_ref_i) begin
    sa_q          <= isa_sa_i[16:0];
    aen_q         <= isa_aen_i;
    sbhe_nq       <= isa_sbhe_ni;
    io_base_q     <= io_base_i;
    io_decode16_q <= io_decode16_i;
    window_flat_q <= window_flat_i;
  end

  // MEMCS16# is made with these before their first edge: of the address that the synchroniser is reset to none is hit.
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) {window_q, slot8_q} <= {10'h3FF, 1'b0};
    else         {window_q, slot8_q} <= {window_i, slot8_i};
  end
  assign host_reset_o = resetdrv;

  // ---------------------------------------------------------------- decoding, at the start of a cycle
  logic       io_hit, mem_hit, byte8;
  logic [3:0] decoded;
  assign io_hit  = ~aen_q & (sa_q[9:4] == io_base_q[5:0]) &
                   (~io_decode16_q | (sa_q[15:10] == {4'h0, io_base_q[7:6]}));
  assign mem_hit = (slot8_q ? la_hit_q[1] : la_hit_q[3]) & (sa_q[16] == window_q[2]) &
                   (window_flat_q | (sa_q[15:14] == window_q[1:0]));
  assign byte8   = sbhe_nq & sa_q[0];  // an 8-bit host's odd byte is on the low lane
  always_comb begin
    decoded = 4'h0;
    case (cmd2_q)
      4'd1 << Ior, 4'd1 << Iow: begin
        decoded[Port]  = io_hit & (sa_q[3] == brick_regs_pkg::HostIoIcrAddr[3]);             // +0..7
        decoded[Pic]   = io_hit & (sa_q[3:2] == brick_regs_pkg::HostIoPicStatusAddr[3:2]);  // +8..11
        decoded[Other] = io_hit & (sa_q[3:2] == brick_regs_pkg::HostIoPageAddr[3:2]);       // +12..15
      end
      4'd1 << Memr, 4'd1 << Memw: decoded[Memory] = mem_hit;
      default: ;  // two commands at once
    endcase
  end

  // ---------------------------------------------------------------- the cycle
  //          command low          I/O read             command still low
  //   Idle ───────────────► Start ─────────────► Show ──────────────────► Shown ──┐
  //                           ├─ read of the RAM ─► Fetch ─ data ─► Show          │ command gone
  //                           └─ any other ──────► Hold                           ▼
  //   Idle ◄── one clock ── Done from any other, DoneShown from Shown ◄───────────┘
  typedef enum logic [2:0] {
    Idle,      // no command
    Start,     // the clock after the one that found a command low
    Fetch,     // data of the RAM has still to come
    Show,      // data is on the bus since this clock
    Shown,     // data was on the bus with the command still low
    Hold,      // nothing to do until the command goes: a write, one of others, a spoilt one, one of before a reset
    Done,      // the clock after the end
    DoneShown  // the same of a read whose data was shown
  } cycle_e;
  cycle_e      cycle_d, cycle_q;
  logic        active, finish;
  // Show or Shown; neither Start of ours at the RAM, nor the RAM busy: flip-flops, because they lead to pads. A master
  // looks at IOCHRDY when it likes, so no logic stands behind that one: nothing shows between two reasons to wait.
  logic        drive_q, iochrdy_q;
  logic [3:0]  kind_q, target_q;
  logic [1:0]  lanes_q, be_q, page_q;
  logic [14:0] mem_addr_q;
  logic [3:0]  io_addr_q;
  logic        byte8_q;
  logic        start, ends, spoilt, io_load, mem_load, takes_effect;
  logic [7:0]  io_rdata;
  logic [15:0] sd_q, wdata_q;     // read data; write data, for who works on clk_ref

  assign finish   = (cycle_q == Done) | (cycle_q == DoneShown);
  assign active   = (cycle_q != Idle) & ~finish;
  assign start    = ~active & (cmd2_q != 4'h0);
  assign ends     = active & (cmd2_q == 4'h0) & ~resetdrv;
  assign spoilt   = active & ((cmd2_q & ~kind_q) != 4'h0);  // a second command
  assign io_load  = (cycle_q == Start) & kind_q[Ior] & (target_q[Port] | target_q[Pic] | target_q[Other]);
  assign mem_load = (cycle_q == Fetch) & iochrdy_q;  // the RAM is not busy
  // RESETDRV that is seen at the end of a cycle or a clock after it makes it void (host-bus:3.8/3).
  assign takes_effect = finish & ~resetdrv;

  always_comb begin
    cycle_d = cycle_q;
    case (cycle_q)
      Idle, Done, DoneShown: begin
        if (start) cycle_d = Start;
        else       cycle_d = Idle;
      end
      Start: begin
        if (io_load)                               cycle_d = Show;
        else if (kind_q[Memr] && target_q[Memory]) cycle_d = Fetch;
        else                                       cycle_d = Hold;
      end
      Fetch: if (mem_load) cycle_d = Show;
      Show:  cycle_d = Shown;
      default: ;
    endcase
    if (ends) begin
      if (cycle_q == Shown) cycle_d = DoneShown;
      else                  cycle_d = Done;
    end
    if (spoilt || resetdrv) cycle_d = Hold;
  end

  always_comb begin
    io_rdata = 8'hFF;
    if (target_q[Port])      io_rdata = hp_rdata_i;
    else if (target_q[Pic])  io_rdata = pic_rdata_i;
    else if (!window_flat_q && io_addr_q == brick_regs_pkg::HostIoPageAddr[3:0]) io_rdata = {6'h3F, page_q};
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      cycle_q    <= Hold;
      drive_q    <= 1'b0;
      iochrdy_q  <= 1'b1;
      kind_q     <= 4'h0;
      target_q   <= 4'h0;
      be_q       <= 2'b00;
      byte8_q    <= 1'b0;
      mem_addr_q <= 15'h0;
      io_addr_q  <= 4'h0;
      page_q     <= 2'b00;
      sd_q       <= 16'hFFFF;
      wdata_q    <= 16'h0;
    end else begin
      cycle_q   <= cycle_d;
      drive_q   <= (cycle_d == Show) | (cycle_d == Shown);
      iochrdy_q <= ~(((cycle_d == Start) & decoded[Memory]) | mem_busy_d_i);
      if (start) begin
        kind_q     <= cmd2_q;
        target_q   <= decoded;
        be_q       <= byte8 ? 2'b10 : {~sbhe_nq, ~sa_q[0]};
        byte8_q    <= byte8;
        mem_addr_q <= {window_flat_q ? sa_q[15:14] : page_q, sa_q[13:1]};
        io_addr_q  <= sa_q[3:0];
      end else if (ends) begin
        wdata_q <= sd_low_q;
      end
      // Of the interrupt controller a second time, as it is when the read acts.
      if (io_load | pic_rd_o) sd_q <= {8'hFF, io_rdata};
      else if (mem_load) sd_q <= byte8_q ? {mem_rdata_i[15:8], mem_rdata_i[15:8]} : mem_rdata_i;
      if (spoilt) target_q <= 4'h0;
      if (finish & kind_q[Iow] & target_q[Other] & ~window_flat_q &
          (io_addr_q == brick_regs_pkg::HostIoPageAddr[3:0])) begin
        page_q <= wdata_q[brick_regs_pkg::HostIoPagePageLsb +: brick_regs_pkg::HostIoPagePageWidth];
      end
      if (resetdrv) begin
        target_q <= 4'h0;
        page_q   <= 2'b00;
      end
    end
  end

  always_ff @(posedge clk_ref_i) begin
    if (start) lanes_q <= (decoded[Memory] & ~byte8) ? {~sbhe_nq, ~sa_q[0]} : 2'b01;
  end

  // ---------------------------------------------------------------- towards the blocks
  assign hp_sel_o     = target_q[Port];
  assign hp_rd_o      = target_q[Port] & (cycle_q == Start) & kind_q[Ior];
  assign hp_rd_done_o = target_q[Port] & (cycle_q == DoneShown) & takes_effect;
  assign hp_wr_o      = target_q[Port] & takes_effect & kind_q[Iow];
  assign hp_addr_o    = io_addr_q[2:0];
  assign hp_wdata_o   = wdata_q[7:0];

  assign pic_sel_o     = target_q[Pic];
  // The first clk_pwm edge with data on the bus saw the command low, alone: they have been shown (host-bus:3.9/6).
  assign pic_rd_o      = target_q[Pic] & (cycle_q == Show) & kind_q[Ior] & (cmd2_q == kind_q) & ~resetdrv;
  assign pic_wr_o      = target_q[Pic] & takes_effect & kind_q[Iow];
  assign pic_addr_o    = io_addr_q[1:0];
  assign pic_wdata_o   = wdata_q[7:0];

  assign mem_sel_o   = target_q[Memory] & active;
  assign mem_rd_o    = kind_q[Memr];
  assign mem_wr_o    = target_q[Memory] & takes_effect & kind_q[Memw];
  assign mem_addr_o  = mem_addr_q;
  assign mem_be_o    = be_q;
  assign mem_wdata_o = byte8_q ? {wdata_q[7:0], wdata_q[7:0]} : wdata_q;

  // ---------------------------------------------------------------- towards the bus
  logic read_low;
  assign read_low = ((kind_q[Ior] & ~isa_ior_ni) | (kind_q[Memr] & ~isa_memr_ni)) & isa_iow_ni & isa_memw_ni;
  assign isa_sd_o       = sd_q;
  assign isa_sd_oe_o    = lanes_q & {2{drive_q & read_low}};
  assign isa_iochrdy_o  = iochrdy_q;
  assign isa_memcs16_no = ~la_hit_q[0];

endmodule : isa_slave

`default_nettype wire
