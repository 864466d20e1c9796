// Rules of the dual-ported RAM at the CPU's pins, host-bus:6.9 and host-bus:2.6/5, where each line comes to the board
// at once or two steps after the CPU has moved it, always the same: pads and wires of up to 8.477 ns, of which the ends
// are the worst. A step is half a period of clk_pwm, 4.2 ns; a pin of the CPU may change at any, and an edge takes what
// stood a step before it. Assumed is of isa_slave what `dpram` assumes, and of the CPU, host-bus:2.2:
// - /RD and /WR are never low together, high and low for a step or more; two falls of one are four steps apart or more,
//   17 ns (19.1 ns with the wait states of host-bus:2.5);
// - select and address stand from the fall to a step after the rise (host-bus:2.6/9), write data from 12.7 ns after the
//   fall to the rise;
// - a strobe of this RAM is low for seven steps or more, 29.7 ns (row 102: 31.6), and ends after /TA is low (row 118);
//   of others nothing more is asked.
// edit: four words of memory instead of 32768, and nothing else asked for (rtl/host/dpram_memory.sv)
//   - mem [0:32767]
//   + mem [0:3]
// proof: pdr
// clocks: several
// steps: 40
// fault R3: the end of /RD does not turn the pins off (rtl/host/dpram.sv)
//   - rst_ni & ~cpu_rd_ni
//   + rst_ni
// fault R4: a write is made though another strobe has fallen since its data were taken (rtl/host/dpram.sv)
//   - = wr_low2_q & ~wr_new;
//   + = wr_low2_q;
// fault R5: /TA falls with the data (rtl/host/dpram.sv)
//   - (rd_falls_i != rd_ack_q)
//   + (rd_falls_i != rd_done_q)
`default_nettype none

module dpram_pins_rules (
  input wire logic        rst_ni,
  input wire logic        rd_ni,         // as the CPU drives them
  input wire logic        wr_ni,
  input wire logic        sel_i,
  input wire logic [1:0]  addr_i,
  input wire logic        wdata_i,       // on all lines of D
  input wire logic        host_sel_i,
  input wire logic        host_rd_i,
  input wire logic        host_wr_i,
  input wire logic [1:0]  host_addr_i,
  input wire logic [1:0]  host_be_i,
  input wire logic        host_wdata_i
);

  localparam logic [3:0] Settled = 4'd7;  // steps behind a fall: its lines are there, the remains of others are gone

  // Time: clk_pwm rises with every other step, clk_ref with every third of these.
  logic [2:0] step_q = 3'd0;
  logic       clk_pwm_q = 1'b0, clk_ref_q = 1'b0, edge_pwm;
  always @($global_clock) begin
    step_q    <= (step_q == 3'd5) ? 3'd0 : step_q + 3'd1;
    clk_pwm_q <= ~clk_pwm_q;
    clk_ref_q <= step_q < 3'd3;
  end
  assign edge_pwm = !clk_pwm_q;  // at the end of this step

  // Lines at the board: as they were so many steps ago.
  (* anyconst *) logic [5:0] late;
  logic [5:0] now, one_q, two_q, there;
  assign now = {rd_ni, wr_ni, sel_i, addr_i, wdata_i};
  initial {one_q, two_q} = {2{6'b110000}};
  always @($global_clock) {one_q, two_q} <= {now, one_q};
  for (genvar i = 0; i < 6; i++) begin : gen_line
    assign there[i] = late[i] ? two_q[i] : now[i];
  end

  logic [1:0]  rd_falls, wr_falls;
  logic        cpu_drive, cpu_wait, cpu_busy, host_busy, host_busy_pin;
  logic [15:0] rdata, host_rdata;
  bus_strobes strobes (.rst_ni, .pa_rd_ni(there[5]), .pa_wr_ni(there[4]), .rd_falls_o(rd_falls),
                       .wr_falls_o(wr_falls));
  dpram dut (.clk_pwm_i(clk_pwm_q), .clk_ref_i(clk_ref_q), .rst_ni, .small_i(1'b0), .rd_falls_i(rd_falls),
             .wr_falls_i(wr_falls), .cpu_sel_i(there[3]), .cpu_x_i(there[1]), .cpu_addr_i({13'd0, there[2]}),
             .cpu_rd_ni(there[5]), .cpu_wr_ni(there[4]), .cpu_wdata_i({16{there[0]}}), .cpu_rdata_o(rdata),
             .cpu_drive_o(cpu_drive), .cpu_wait_o(cpu_wait), .cpu_busy_o(cpu_busy),
             .mem_sel_i(host_sel_i), .mem_rd_i(host_rd_i), .mem_wr_i(host_wr_i),
             .mem_addr_i({13'd0, host_addr_i}), .mem_be_i(host_be_i),
             .mem_wdata_i({16{host_wdata_i}}), .mem_rdata_o(host_rdata), .mem_busy_o(host_busy),
             .host_busy_o(host_busy_pin));
  // From inside the CPU's port of the memory, and nothing of the arbiter.
  (* hierconn *) wire logic        \dut.u_memory.a_we_i ;
  (* hierconn *) wire logic        \dut.u_memory.a_re_i ;
  (* hierconn *) wire logic [14:0] \dut.u_memory.a_addr_i ;
  (* hierconn *) wire logic [15:0] \dut.u_memory.a_wdata_i ;

  // ---------------------------------------------------------------- both sides, a step ago
  logic        started_q = 1'b0, awake_q = 1'b0, rd_nq = 1'b1, wr_nq = 1'b1, wait_q = 1'b0;
  logic        sel_q, wdata_q, host_sel_q = 1'b0, host_rd_q, host_wr_q = 1'b0, host_wdata_q;
  logic [1:0]  addr_q, host_addr_q, host_be_q;
  logic [2:0]  rd_fell_q = 3'b000, wr_fell_q = 3'b000;
  logic [3:0]  low_q = 4'd0;  // steps that a strobe has been low
  always @($global_clock) begin
    {started_q, awake_q, rd_nq, wr_nq, wait_q} <= {1'b1, started_q, rd_ni, wr_ni, cpu_wait};
    {sel_q, addr_q, wdata_q} <= {sel_i, addr_i, wdata_i};
    {host_sel_q, host_rd_q, host_wr_q} <= {host_sel_i, host_rd_i, host_wr_i};
    {host_addr_q, host_be_q, host_wdata_q} <= {host_addr_i, host_be_i, host_wdata_i};
    low_q     <= (rd_ni & wr_ni) ? 4'd0 : low_q + {3'd0, low_q != Settled};
    rd_fell_q <= {rd_fell_q[1:0], rd_nq & ~rd_ni};
    wr_fell_q <= {wr_fell_q[1:0], wr_nq & ~wr_ni};
  end
  logic was_low, rise, reads, ours;
  assign was_low = ~rd_nq | ~wr_nq;
  assign rise    = was_low & rd_ni & wr_ni;
  assign reads   = !rd_ni && sel_i;
  assign ours    = was_low && sel_q && low_q >= 4'd5 && (~rd_ni | ~wr_ni);
  always_comb begin
    // guarantee: power-on
    assume (rst_ni == started_q);
    assume (awake_q || (rd_ni && wr_ni && !host_sel_i && !host_wr_i));
    // guarantee: host-bus:2.5/6, `bus: a, *`
    assume (rd_ni || wr_ni);
    // guarantee: host-bus:2.2/113, `bus: 113, *`; host-bus:2.2/114, `bus: 114, *`
    assume ((!rd_nq || rd_ni || rd_fell_q == 3'b000) && (!wr_nq || wr_ni || wr_fell_q == 3'b000));
    if (was_low) begin
      // guarantee: host-bus:2.2/113, `bus: 113, *`; host-bus:2.2/114, `bus: 114, *`
      assume ((rd_nq || wr_ni) && (wr_nq || rd_ni));
      // guarantee: host-bus:2.5/7, `bus: b, *`
      assume (sel_i == sel_q && addr_i == addr_q);
      // guarantee: host-bus:2.6/6, `bus: w1, *`
      assume (low_q < 4'd3 || wdata_i == wdata_q);
      // guarantee: host-bus:2.2/118, `bus: 118, *`; host-bus:2.2/102, `bus: 102, *`
      assume (!rise || !sel_q || (!wait_q && low_q >= 4'd7));
    end
    // guarantee: isa_slave R3, R4
    assume (!host_wr_i || (!host_sel_i && !host_rd_i));
    if (step_q != 3'd1) begin
      // guarantee: isa_slave R3
      assume (host_sel_i == host_sel_q && host_wr_i == host_wr_q && host_wdata_i == host_wdata_q);
      assume (host_rd_i == host_rd_q && host_addr_i == host_addr_q && host_be_i == host_be_q);
    end else begin
      // guarantee: isa_slave R3
      assume (!host_wr_i || (host_sel_q && !host_sel_i && !host_rd_q));
      assume (!host_sel_q ||
              (host_rd_i == host_rd_q && host_addr_i == host_addr_q && host_be_i == host_be_q));
    end
  end

  // ---------------------------------------------------------------- what an observer of pins and memory sees
  logic        write_a, made, cpu_busy_q = 1'b0, read_q = 1'b0, made_q = 1'b0, due_q = 1'b0, due_bit_q;
  logic [1:0]  due_addr_q, driven_q = 2'd0, reads_q = 2'd0;
  logic [15:0] rdata_q;
  assign write_a = \dut.u_memory.a_we_i ;
  assign made    = edge_pwm && write_a && \dut.u_memory.a_addr_i [1:0] == (due_q ? due_addr_q : addr_i) &&
                   \dut.u_memory.a_wdata_i == {16{due_q ? due_bit_q : wdata_i}};
  always @($global_clock) begin
    cpu_busy_q <= cpu_busy;
    rdata_q    <= rdata;
    driven_q   <= {driven_q[0], cpu_drive};
    reads_q    <= {reads_q[0], reads};
    read_q     <= edge_pwm && \dut.u_memory.a_re_i && \dut.u_memory.a_addr_i [1:0] == addr_i;
    made_q     <= !wr_ni && (made_q || (made && !due_q));
    // A write whose strobe has ended, after /TA was low, may be made a little later.
    if (rise && !wr_nq && sel_q && !made_q) {due_q, due_addr_q, due_bit_q} <= {!made, addr_q, wdata_q};
    else if (due_q)                         due_q <= !made;
  end

  always @($global_clock) begin
    // R1: BUSY means wait: /TA is up with BUSY.
    if (cpu_busy && ours) begin
      R1: assert (cpu_wait);
      C1: cover (wr_ni);
    end

    // R2: From seven steps after its fall on, when the remains of others are gone, the CPU becomes BUSY only by the
    // word that the host is at or has just left, and if one of the two writes.
    if (cpu_busy && !cpu_busy_q && ours && low_q == Settled) begin
      R2: assert (addr_q == host_addr_q && (!host_rd_q || !wr_nq));
      C2: cover (host_rd_q);
    end

    // R3: The CPU's data pins are driven in a read of this RAM alone, from the edge on that has read the memory at its
    // address, and stand; they are off with its end, with a late /RD two steps behind it.
    R3: assert (!cpu_drive || ((reads || (late[5] && reads_q != 2'd0)) && (driven_q[0] ? rdata == rdata_q : read_q)));
    C3: cover (cpu_drive && cpu_wait);

    // R4: The memory is written by the CPU's side once for a write of this RAM, at its address and with its data, and
    // never else.
    if (edge_pwm && write_a) begin
      R4: assert (made && (due_q || (!wr_nq && sel_q && !made_q)));
      C4: cover (!due_q);
    end

    // R5: /TA of a read falls a clock after its data: the CPU may take these that much sooner (rows 105, 118).
    if (reads && low_q >= 4'd3 && !cpu_wait) begin
      R5: assert (cpu_drive && driven_q == 2'b11);
      C5: cover (low_q == Settled);
    end

    // R6: A read that heeds /TA gets its word: it is driven at the end of /RD.
    if (rise && sel_q && !rd_nq) begin
      R6: assert (driven_q[0]);
      C6: cover (cpu_drive);
    end
  end

endmodule : dpram_pins_rules

`default_nettype wire
