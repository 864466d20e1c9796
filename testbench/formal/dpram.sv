// Rules of the dual-ported RAM's arbiter, host-bus:6.9 and host-bus:2.6/5, at the CPU's pins: the two sides never meet
// in a word, both come to their turn, and each strobe gets what it asks for. That what either reads is what was last
// written is tested, not proved. Each line of the CPU comes to the board at once or up to 8.477 ns late (`late_lines`).
// A pin of the CPU may change at any step, and an edge takes what stood a step before it. Assumed, all else is free:
// - of the CPU, host-bus:2.2: /RD and /WR are never low together, high and low for a step or more; two falls of one are
//   four steps apart or more, 17 ns (19.1 ns with the wait states of host-bus:2.5); select and address stand from the
//   fall to a step after the rise (host-bus:2.6/9), write data from 12.7 ns after the fall to the rise; a strobe of
//   this RAM is low for seven steps or more, 29.7 ns (row 102: 31.6), and ends after /TA is low (row 118); of others
//   nothing more is asked;
// - of isa_slave: its outputs change with clk_ref, direction and address stand from the command's start to the clock
//   after its end, in which a write may have its strobe (`isa_slave`, R3 and R4). It may end a command at any time,
//   BUSY or not, with or without a strobe.
// edit: four words of memory instead of 32768, and nothing else asked for (rtl/host/dpram_memory.sv)
//   - mem [0:32767]
//   + mem [0:3]
// proof: pdr
// clocks: several
// steps: 60
// fault R2: the host does not see that the CPU asks at the same edge (rtl/host/dpram.sv)
//   - | (request & conflict & ~mem_busy_q);
//   + ;
// fault R6: only a new strobe of this RAM ends the one before (rtl/host/dpram.sv)
//   - (fallen || !(own_wr_q
//   + (request || !(own_wr_q
// fault R8: the end of /RD does not turn the pins off (rtl/host/dpram.sv)
//   - rst_ni & ~cpu_rd_ni
//   + rst_ni
// fault R9: a write is made though another strobe has fallen since its data were taken (rtl/host/dpram.sv)
//   - = wr_low2_q & ~wr_new;
//   + = wr_low2_q;
// fault R10: /TA falls with the data (rtl/host/dpram.sv)
//   - (rd_falls_i != rd_ack_q)
//   + (rd_falls_i != rd_done_q)
// fault R11: the host hears of BUSY when it begins, not before (rtl/host/dpram.sv)
//   - assign mem_busy_d_o = mem_busy_d;
//   + assign mem_busy_d_o = mem_busy_q;
`default_nettype none

module dpram_rules (
  input wire logic        rst_ni,
  input wire logic        rd_ni,         // as the CPU drives them
  input wire logic        wr_ni,
  input wire logic        sel_i,
  input wire logic [1:0]  addr_i,
  input wire logic        wdata_i,       // on all lines of D, as that of the host
  input wire logic        host_sel_i,
  input wire logic        host_rd_i,
  input wire logic        host_wr_i,
  input wire logic [1:0]  host_addr_i,
  input wire logic [1:0]  host_be_i,
  input wire logic        host_wdata_i
);

  localparam logic [3:0] Settled = 4'd7;  // steps behind a fall: its lines are there, the remains of others are gone

  logic [2:0] step;
  logic       clk_pwm, clk_ref, edge_pwm, edge_ref;
  proof_clocks clocks (.clk_pwm_o(clk_pwm), .clk_ref_o(clk_ref), .edge_pwm_o(edge_pwm), .edge_ref_o(edge_ref),
                       .step_o(step));

  // Lines at the board, in the order of `there`: /RD, /WR, select, address, data.
  logic [5:0] there, late;
  late_lines #(.Width(6), .Idle(6'b110000)) lines (.now_i({rd_ni, wr_ni, sel_i, addr_i, wdata_i}), .there_o(there),
                                                   .late_o(late));
  logic [3:0] skew;  // steps that a late line adds
  assign skew = (late != 6'd0) ? 4'd2 : 4'd0;

  logic [1:0]  rd_falls, wr_falls;
  logic        cpu_drive, cpu_wait, cpu_busy, host_busy, host_busy_d;
  logic [15:0] rdata, host_rdata;
  bus_strobes strobes (.rst_ni, .pa_rd_ni(there[5]), .pa_wr_ni(there[4]), .rd_falls_o(rd_falls),
                       .wr_falls_o(wr_falls));
  dpram dut (.clk_pwm_i(clk_pwm), .clk_ref_i(clk_ref), .rst_ni, .small_i(1'b0), .rd_falls_i(rd_falls),
             .wr_falls_i(wr_falls), .cpu_sel_i(there[3]), .cpu_x_i(there[1]), .cpu_addr_i({13'd0, there[2]}),
             .cpu_rd_ni(there[5]), .cpu_wr_ni(there[4]), .cpu_wdata_i({16{there[0]}}), .cpu_rdata_o(rdata),
             .cpu_drive_o(cpu_drive), .cpu_wait_o(cpu_wait), .cpu_busy_o(cpu_busy),
             .mem_sel_i(host_sel_i), .mem_rd_i(host_rd_i), .mem_wr_i(host_wr_i),
             .mem_addr_i({13'd0, host_addr_i}), .mem_be_i(host_be_i),
             .mem_wdata_i({16{host_wdata_i}}), .mem_rdata_o(host_rdata),
             .mem_busy_d_o(host_busy_d), .host_busy_o(host_busy));
  // From inside the ports of the memory, and nothing of the arbiter.
  (* hierconn *) wire logic        \dut.u_memory.a_we_i ;
  (* hierconn *) wire logic        \dut.u_memory.a_re_i ;
  (* hierconn *) wire logic [14:0] \dut.u_memory.a_addr_i ;
  (* hierconn *) wire logic [15:0] \dut.u_memory.a_wdata_i ;
  (* hierconn *) wire logic [1:0]  \dut.u_memory.b_we_i ;
  (* hierconn *) wire logic        \dut.u_memory.b_re_i ;

  // ---------------------------------------------------------------- both sides, a step ago
  logic        started_q = 1'b0, awake_q = 1'b0, rd_nq = 1'b1, wr_nq = 1'b1, wait_q = 1'b0;
  logic        sel_q, host_sel_q = 1'b0, host_rd_q, host_wr_q = 1'b0;
  logic [1:0]  addr_q, host_addr_q, host_be_q;
  logic        wdata_q, host_wdata_q;
  logic [15:0] rdata_q;
  logic [2:0]  rd_fell_q = 3'b000, wr_fell_q = 3'b000;
  logic [3:0]  low_q = 4'd0;  // steps that a strobe has been low
  always @($global_clock) begin
    {started_q, awake_q, rd_nq, wr_nq, wait_q} <= {1'b1, started_q, rd_ni, wr_ni, cpu_wait};
    {sel_q, addr_q, wdata_q, rdata_q} <= {sel_i, addr_i, wdata_i, rdata};
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
  assign ours    = was_low && sel_q && low_q >= 4'd3 + skew && (~rd_ni | ~wr_ni);
  always_comb begin
    // guarantee: one reset
    assume (rst_ni == started_q);
    // guarantee: power-on
    assume (awake_q || (rd_ni && wr_ni && !host_sel_i && !host_wr_i));
    // guarantee: host-bus:2.5/6, `bus: a, {gate ICs AA1; dual-ported RAM AA2; default area}`
    assume (rd_ni || wr_ni);
    // guarantee: host-bus:2.2/113, host-bus:2.2/114,
    //   `bus: {113; 114}, {gate ICs AA1; dual-ported RAM AA2; default area}`
    assume ((!rd_nq || rd_ni || rd_fell_q == 3'b000) && (!wr_nq || wr_ni || wr_fell_q == 3'b000));
    if (was_low) begin
      // guarantee: host-bus:2.2/113, host-bus:2.2/114,
      //   `bus: {113; 114}, {gate ICs AA1; dual-ported RAM AA2; default area}`
      assume ((rd_nq || wr_ni) && (wr_nq || rd_ni));
      // guarantee: host-bus:2.5/7, `bus: b, {gate ICs AA1; dual-ported RAM AA2; default area}`
      assume (sel_i == sel_q && addr_i == addr_q);
      // guarantee: host-bus:2.6/6, `bus: w1, dual-ported RAM AA2`
      assume (low_q < 4'd3 || wdata_i == wdata_q);
      // guarantee: host-bus:2.2/118, `bus: 118, dual-ported RAM AA2`; host-bus:2.2/102, `bus: 102, dual-ported RAM AA2`
      assume (!rise || !sel_q || (!wait_q && low_q >= 4'd7));
    end
    // guarantee: isa_slave R3, R4
    assume (!host_wr_i || (!host_sel_i && !host_rd_i));
    if (step != 3'd1) begin
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

  // ---------------------------------------------------------------- what an observer of the pins counts
  logic       conflict, host_here, host_ends, asked_q = 1'b0, ended_q = 1'b0, cpu_busy_q = 1'b0;
  logic [3:0] cpu_steps_q = 4'd0;
  logic [4:0] host_steps_q = 5'd0;
  logic [1:0] turns_q = 2'd0;
  assign host_here = host_sel_i | (asked_q & ~host_rd_i);  // a write ends with the clock after its command
  assign conflict  = host_here & (host_addr_i == addr_i) & (~host_rd_i | ~wr_ni);
  assign host_ends = host_sel_q & ~host_sel_i;
  always @($global_clock) begin
    cpu_busy_q <= cpu_busy;
    // The CPU: steps of /TA since its fall or the host's end; host accesses that it waited for.
    cpu_steps_q <= (!cpu_wait || conflict || !was_low) ? 4'd0 : cpu_steps_q + {3'd0, cpu_steps_q != 4'd15};
    turns_q     <= !cpu_busy ? 2'd0 : turns_q + {1'd0, host_ends && conflict && turns_q != 2'd3};
    // The host: steps of BUSY since the CPU's strobe has first been high.
    ended_q      <= host_busy & (ended_q | (rd_ni & wr_ni));
    host_steps_q <= !(host_busy && ended_q) ? 5'd0 : host_steps_q + {4'd0, host_steps_q != 5'd31};
  end

  logic told_q = 1'b0;  // what stood at the last edge of clk_ref
  always @($global_clock) if (edge_ref) told_q <= host_busy_d;

  logic touch_a, touch_b, write_a, write_b;
  assign write_a = \dut.u_memory.a_we_i ;
  assign write_b = \dut.u_memory.b_we_i != 2'b00;
  assign touch_a = write_a | \dut.u_memory.a_re_i ;
  assign touch_b = write_b | \dut.u_memory.b_re_i ;

  // Who may have a word, as the two sides must believe. The CPU, behind what late lines leave of the strobe before: in
  // a read while its pins are driven; in a write from /TA low on until the memory has been written. The host: from the
  // edge of clk_ref that found its command and left BUSY low, to its end.
  logic       read_q = 1'b0, made_q = 1'b0, due_q = 1'b0, due_bit_q;
  logic       cpu_reads, cpu_writes, host_in, made;
  logic [1:0] due_addr_q, drive_q = 2'd0, reads_q = 2'd0;
  logic [3:0] due_steps_q = 4'd0;
  assign cpu_reads  = reads && low_q >= 4'd3 && cpu_drive;
  assign cpu_writes = !wr_ni && sel_i && low_q >= 4'd3 && !cpu_wait && !made_q;
  assign host_in    = host_here && asked_q && !host_busy;
  assign made       = edge_pwm && write_a && \dut.u_memory.a_addr_i [1:0] == (due_q ? due_addr_q : addr_i) &&
                      \dut.u_memory.a_wdata_i == {16{due_q ? due_bit_q : wdata_i}};
  always @($global_clock) begin
    drive_q <= {drive_q[0], cpu_drive};
    reads_q <= {reads_q[0], reads};
    read_q  <= edge_pwm && \dut.u_memory.a_re_i && \dut.u_memory.a_addr_i [1:0] == addr_i;
    made_q  <= !wr_ni && (made_q || (made && !due_q));
    if (edge_ref) asked_q <= host_sel_i;
    // A write whose strobe has ended, after /TA was low, may be made a little later.
    if (rise && !wr_nq && sel_q && !made_q) begin
      {due_q, due_addr_q, due_bit_q, due_steps_q} <= {!made, addr_q, wdata_q, 4'd0};
    end else if (due_q) begin
      {due_q, due_steps_q} <= {!made, due_steps_q + 4'd1};
    end
  end

  always @($global_clock) begin
    // R1: The ports never touch one word at one edge if one of them writes: mutual exclusion in the memory.
    if (edge_ref && touch_a && touch_b && \dut.u_memory.a_addr_i [1:0] == host_addr_i) begin
      R1: assert (!write_a && !write_b);
      C1: cover (!cpu_busy);
    end

    // R2: No side touches a word that the other may have, if one of the two writes.
    if ((edge_pwm && touch_a && host_in && \dut.u_memory.a_addr_i [1:0] == host_addr_i) ||
        (edge_ref && touch_b && ((cpu_reads || cpu_writes) && addr_i == host_addr_i ||
                                 due_q && due_addr_q == host_addr_i))) begin
      R2: assert ((!touch_a || !edge_pwm || !host_in || \dut.u_memory.a_addr_i [1:0] != host_addr_i ||
                   (!write_a && host_rd_i)) &&
                  (!touch_b || !edge_ref || !(cpu_reads && addr_i == host_addr_i && write_b)) &&
                  (!touch_b || !edge_ref || !(cpu_writes && addr_i == host_addr_i)) &&
                  (!touch_b || !edge_ref || !(due_q && due_addr_q == host_addr_i)));
      C2: cover (host_sel_i && was_low);
    end

    // R3: BUSY means wait: /TA is up with BUSY. A strobe that heeds /TA gets its word: it is driven at the end of /RD,
    // and a write is made, with its address and data, at most 8 steps after /WR, with a late line 10.
    R3: assert ((!cpu_busy || cpu_wait || !ours) && (!rise || !sel_q || rd_nq || drive_q[0]) &&
                due_steps_q < 4'd7 + skew);
    C3: cover (due_q && due_steps_q == 4'd1);

    // R4: The CPU is let in within 8 steps, 34 ns, of its fall or the end of the host's access to its word, with a late
    // line 10 steps, 42 ns.
    if (cpu_wait) begin
      R4: assert (cpu_steps_q <= 4'd7 + skew);
      C4: cover (cpu_steps_q == 4'd7);
    end

    // R5: While the CPU is BUSY the host ends one access to its word, and no second: no starvation.
    if (cpu_busy) begin
      R5: assert (turns_q <= 2'd1);
      C5: cover (turns_q == 2'd1);
    end

    // R6: The host is let in at most 13 steps, 55 ns, after the CPU's strobe ended, with a late line 15, even if a new
    // one falls at once.
    if (host_busy) begin
      R6: assert (host_steps_q <= 5'd13 + {1'b0, skew});
      C6: cover (host_steps_q == 5'd6 && !rd_ni);
    end

    // R7: From five steps after its fall on, with a late line seven, when the remains of others are gone, the CPU
    // becomes BUSY only by the word that the host is at or has just left, and if one of the two writes.
    if (cpu_busy && !cpu_busy_q && ours && low_q >= 4'd5 + skew) begin
      R7: assert (addr_q == host_addr_q && (!host_rd_q || !wr_nq));
      C7: cover (host_rd_q);
    end

    // R8: The CPU's data pins are driven in a read of this RAM alone, from the edge on that has read the memory at its
    // address, and stand; they are off with its end, with a late /RD two steps behind it.
    R8: assert (!cpu_drive || ((reads || (late[5] && reads_q != 2'd0)) && (drive_q[0] ? rdata == rdata_q : read_q)));
    C8: cover (cpu_drive && cpu_wait);

    // R9: The memory is written by the CPU's side once for a write of this RAM, at its address and with its data, and
    // never else.
    if (edge_pwm && write_a) begin
      R9: assert (made && (due_q || (!wr_nq && sel_q && !made_q)));
      C9: cover (!due_q);
    end

    // R10: /TA of a read falls a clock after its data: the CPU may take these that much sooner (rows 105, 118).
    if (reads && low_q >= 4'd3 && !cpu_wait) begin
      R10: assert (cpu_drive && drive_q == 2'b11);
      C10: cover (low_q == Settled);
    end

    // R11: The host is BUSY between two edges of clk_ref if the first of them was told so: isa_slave takes it there.
    R11: assert (host_busy == told_q);
    C11: cover (told_q && ended_q);
  end

endmodule : dpram_rules

`default_nettype wire
