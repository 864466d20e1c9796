// Rules of an SSI channel with its control word, servo-ic:11.9, for whatever is written at any time, any data line and
// any trigger times: when its clock moves, how many clocks a word has, when a result is loaded and what is in it. The
// word may change at every tick, although its clock is a third. Assumed is what ssi_group.sv proves of the group: a
// frame starts at rest, falls and rises take turns from there on, and none follows but while some channel is active.
// proof: induction 3
// clocks: one
// steps: 80
// fault R2: a word without its first clock (rtl/ssi/ssi_channel.sv)
//   - {5'd0, odd_i | even_i} + 6'd1;
//   + {5'd0, odd_i | even_i};
// fault R3: a bit is seen in the result before the word is whole (rtl/ssi/ssi_channel.sv)
//   - if (load_q) begin
//   + if (load_q || rise_i) begin
// fault R6: each bit turned over (rtl/ssi/ssi_channel.sv)
//   - data_i ^ (gray_i
//   + ~data_i ^ (gray_i
// fault R7: parity of the position alone (rtl/ssi/ssi_channel.sv)
//   - if (!first_q) odd_q
//   + if (!first_q && !parity_bit) odd_q
// fault R8: lengths above 32 as they are asked for (rtl/ssi/ssi_channel_regs.sv)
//   - (asked > MostBits) ? MostBits : asked
//   + asked
// fault R9: a word that is written with the trigger has its enable cleared (rtl/ssi/ssi_channel_regs.sv)
//   - shot_i ^ (we_i & single_i)
//   + shot_i
// fault R10: off, the clock stops in the frame (rtl/ssi/ssi_channel_regs.sv)
//   - geo_i | word_q[10]
//   + geo_i ? word_q[1] : word_q[10]
// fault R11: the code of a mode that is off (rtl/ssi/ssi_channel_regs.sv)
//   - count_i[1] ? count_i[0] : word_q[11]
//   + count_i[0]
`default_nettype none

module ssi_channel_rules (
  input wire logic       clk_i,
  input wire logic       more_i,   // the group moves for another reason
  input wire logic       start_i,
  input wire logic       refuse_i,
  input wire logic       fall_i,
  input wire logic       rise_i,
  input wire logic       end_i,
  input wire logic       we_i,
  input wire logic [5:0] flags_i,
  input wire logic [5:0] count_i,
  input wire logic       data_i
);

  logic rst_nq = 1'b0;
  always @(posedge clk_i) rst_nq <= 1'b1;

  (* anyconst *) logic geo;  // product

  logic        clk, active, begins, shot, parity_error, enable, single, driver, gray, odd, even;
  logic [5:0]  bits;
  logic [15:0] word;
  ssi_channel_regs regs (.clk_ref_i(clk_i), .rst_ni(rst_nq), .geo_i(geo), .we_i, .rd_a_i(1'b0), .flags_i, .count_i,
                         .word_o(word), .high_o(), .single_i(begins), .shot_i(shot), .position_i(8'h0),
                         .parity_error_i(1'b0), .enable_o(enable), .shot_o(single), .driver_o(driver),
                         .bits_o(bits), .gray_o(gray), .odd_o(odd), .even_o(even));
  logic [31:0] position;
  logic        data;
  sync2 #(.Reset(1'b1)) sync (.clk_i, .rst_ni(rst_nq), .d_i(data_i), .q_o(data));
  logic [7:0]  refused;
  ssi_channel dut (.clk_pwm_i(clk_i), .rst_ni(rst_nq), .moves_i(start_i | refuse_i | fall_i | rise_i | more_i),
                   .start_i, .refuse_i, .fall_i, .rise_i, .enable_i(enable),
                   .shot_i(single), .driver_i(driver), .bits_i(bits), .gray_i(gray), .odd_i(odd), .even_i(even),
                   .data_i(data), .clk_o(clk), .active_o(active), .single_o(begins), .shot_o(shot),
                   .position_o(position), .parity_error_o(parity_error), .refused_o(refused));

  // The group: at rest, clock high, clock low.
  logic run_q = 1'b0, low_q = 1'b0;
  always @(posedge clk_i) begin
    if (start_i)      run_q <= 1'b1;
    else if (end_i)   run_q <= 1'b0;
    if (fall_i)       low_q <= 1'b1;
    else if (rise_i)  low_q <= 1'b0;
  end
  always_comb begin
    // guarantee: ssi_group R1
    assume (!start_i || (rst_nq && !run_q));
    // guarantee: ssi_group R2
    assume (!refuse_i || run_q);
    // guarantee: ssi_group R3, R4
    assume (!fall_i || (!low_q && !end_i && (run_q || start_i)));
    assume (!rise_i || low_q);
    // guarantee: ssi_group R6, R7
    assume (!end_i || (run_q && !low_q && !active));
  end

  // The clocks that its word has, as the trigger found it, and those that were.
  logic [5:0]  all_q = 6'd0, seen_q = 6'd0;
  logic        frame_q = 1'b0, whole_q = 1'b0, whole1_q = 1'b0, shot_q = 1'b0;
  logic [31:0] position_q = 32'h0;
  logic [7:0]  refused_q = 8'd0;
  // Of these: the pin two ticks ago, bit k of a word without parity and Gray, the number of ones.
  (* anyconst *) logic [4:0] k;
  logic        data1_q = 1'b1, data2_q = 1'b1, plain_q = 1'b0, bit_q = 1'b0, ones_q = 1'b0, error_q = 1'b0;
  logic [5:0]  place;  // of that bit in the shift register, 63 before it has come
  assign place = {1'b0, k} + seen_q - all_q;
  always @(posedge clk_i) begin
    data1_q <= data_i || !rst_nq;
    data2_q <= data1_q || !rst_nq;
    if (start_i && enable) begin
      plain_q <= !gray && !odd && !even;
      ones_q  <= 1'b0;
    end else if (frame_q && rise_i) begin
      if (gray || odd || even) plain_q <= 1'b0;
      if (seen_q == all_q - {1'b0, k} - 6'd1) bit_q <= data2_q;
      if (seen_q != 6'd0) ones_q <= ones_q ^ data2_q;
    end
    if (whole_q) error_q <= (odd && !ones_q) || (even && ones_q);
  end
  always @(posedge clk_i) begin
    if (start_i && enable) begin
      all_q   <= bits + {5'd0, odd | even} + 6'd1;
      seen_q  <= 6'd0;
      frame_q <= 1'b1;
    end else if (frame_q && rise_i) begin
      seen_q  <= seen_q + 6'd1;
      frame_q <= seen_q + 6'd1 != all_q;
    end
    whole_q    <= frame_q && rise_i && seen_q + 6'd1 == all_q;
    whole1_q   <= whole_q;
    shot_q     <= shot;
    position_q <= position;
    refused_q  <= refused_q + {7'd0, refuse_i & enable};
  end

  // A single frame that began a tick ago, two ticks ago, and no word was written since, at that edge neither.
  logic single1_q = 1'b0, single2_q = 1'b0, enable_q = 1'b0, we_q = 1'b0;
  always @(posedge clk_i) begin
    single1_q <= start_i && enable && single && !we_i;
    single2_q <= single1_q && !we_i;
    enable_q  <= word[12];
    we_q      <= we_i;
  end

  // A fall in a frame of its own, on a Geo PMAC; the code of the last mode there that was on.
  logic fell_q = 1'b0, code_q = 1'b0;
  always @(posedge clk_i) begin
    fell_q <= geo && fall_i && (frame_q || (start_i && enable));
    if (rst_nq && we_i && count_i[1]) code_q <= count_i[0];
  end

  // From inside: the clocks left, a whole word.
  (* hierconn *) wire logic [5:0] \dut.rises_q ;
  (* hierconn *) wire logic       \dut.load_q , \dut.first_q , \dut.odd_q , \sync.sync1_q , \sync.sync2_q ;
  (* hierconn *) wire logic [31:0] \dut.shift_q ;
  (* hierconn *) wire logic        \regs.shot_seen_q ;

  always @(posedge clk_i) if (rst_nq) begin
    // L1: The design's count of clocks left and the one here of those that were make the whole.
    L1: assert (active == frame_q && (!frame_q || (\dut.rises_q == all_q - seen_q && seen_q < all_q)) &&
                (frame_q || seen_q == all_q) && (run_q || !frame_q) && (run_q || !low_q));

    // L2: A word is loaded when it has just become whole.
    L2: assert (\dut.load_q == whole_q);

    // L3: Two flip-flops take the pin; the first clock takes no bit, and the number of ones is that of the taken.
    L3: assert (\sync.sync1_q == data1_q && \sync.sync2_q == data2_q &&
                (!frame_q || (\dut.first_q == (seen_q == 6'd0))) && \dut.odd_q == ones_q && all_q <= 6'd34 &&
                (!frame_q || (all_q >= 6'd13)));

    // L4: Bit k moves up with every bit that follows it.
    L4: assert (!plain_q || {1'b0, k} > all_q - 6'd2 || seen_q < all_q - {1'b0, k} || all_q == 6'd0 ||
                \dut.shift_q [place[4:0]] == bit_q);

    // L5: A turn that has not been seen is that of a single frame whose word stands.
    L5: assert ((shot != \regs.shot_seen_q ) == single1_q);

    // R1: The clock is low only while the group's is, and only in a frame of its own.
    if (!clk) begin
      R1: assert (low_q && frame_q);
      C1: cover (seen_q == 6'd3);
    end

    // R2: It takes part for as many clocks as its word has bits, with parity, and one more.
    if (seen_q != 6'd0) begin
      R2: assert (active == (seen_q != all_q) && active == frame_q);
      C2: cover (seen_q == 6'd13 && all_q == 6'd13);
    end

    // R3: A result changes only one edge after the last rise.
    if (position != position_q) begin
      R3: assert (whole1_q);
      C3: cover (position == 32'h123);
    end

    // R4: A single frame is told once, when it begins.
    if (shot != shot_q) begin
      R4: assert (frame_q && seen_q == 6'd0);
      C4: cover (clk);
    end

    // R5: It counts the triggers that are refused while it is enabled.
    R5: assert (refused == refused_q);
    C5: cover (refused_q == 8'd3);

    // R6: Each bit of a binary word is the pin's level two ticks before the rise that takes it.
    if (whole1_q && plain_q && {1'b0, k} < all_q - 6'd1) begin
      R6: assert (position[k] == bit_q);
      C6: cover (k == 5'd11 && bit_q);
    end

    // R7: The error of parity is that of all bits on the line, as the word asks for it when it is whole.
    if (whole1_q) begin
      R7: assert (parity_error == error_q);
      C7: cover (error_q);
    end

    // R8: A frame has 12 to 32 bits, on a Geo PMAC 12, 16, 20 or 24; there is no parity with the reserved code.
    if (start_i && enable) begin
      R8: assert (bits >= 6'd12 && bits <= 6'd32 && !(odd && even) && (word[15:14] != 2'b11 || !(odd || even)) &&
                  (!geo || (bits <= 6'd24 && bits[1:0] == 2'b00 && !odd && !even)));
      C8: cover (!geo && bits == 6'd32 && odd);
    end

    // R9: The trigger of a single frame ends the enable of its own word, not that of a word written with it or since.
    if (!geo && !we_q) begin
      R9: assert (word[12] == (enable_q && !single2_q));
      C9: cover (enable_q && !word[12]);
    end

    // R10: A Geo PMAC shows each clock of a frame that has begun, also when its word has switched the channel off.
    if (fell_q) begin
      R10: assert (!clk);
      C10: cover (!enable);
    end

    // R11: Its code is that of the last mode that was on.
    if (geo) begin
      R11: assert (gray == code_q);
      C11: cover (frame_q && gray && !enable && !word[0]);
    end
  end

endmodule : ssi_channel_rules

`default_nettype wire
