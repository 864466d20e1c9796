// Rules of an SSI channel, servo-ic:11.9, for whatever control word, data line and trigger times: when its clock moves,
// how many clocks a word has, when a result is loaded and what is in it. Assumed is what its group does: a frame starts
// at rest, falls and rises take turns from there on, and none follows but while some channel is active.
// proof: induction 3
// clocks: one
// steps: 80
// fault R2: a word without its first clock (rtl/ssi/ssi_channel.sv)
//   - {5'd0, odd_i | even_i} + 6'd1;
//   + {5'd0, odd_i | even_i};
// fault R3: a bit is seen in the result before the word is whole (rtl/ssi/ssi_channel.sv)
//   - if (load_q) begin
//   + if (load_q || rise_i) begin
`default_nettype none

module ssi_channel_rules (
  input wire logic       clk_i,
  input wire logic       start_i,
  input wire logic       refuse_i,
  input wire logic       fall_i,
  input wire logic       rise_i,
  input wire logic       end_i,
  input wire logic       enable_i,
  input wire logic       shot_i,
  input wire logic       driver_i,
  input wire logic [5:0] bits_i,
  input wire logic       gray_i,
  input wire logic       odd_i,
  input wire logic       even_i,
  input wire logic       data_i
);

  logic rst_nq = 1'b0;
  always @(posedge clk_i) rst_nq <= 1'b1;

  logic        clk, active, shot, parity_error;
  logic [31:0] position;
  logic [7:0]  refused;
  ssi_channel dut (.clk_pwm_i(clk_i), .rst_ni(rst_nq), .start_i, .refuse_i, .fall_i, .rise_i, .enable_i, .shot_i,
                   .driver_i, .bits_i, .gray_i, .odd_i, .even_i, .data_i, .clk_o(clk), .active_o(active),
                   .shot_o(shot), .position_o(position), .parity_error_o(parity_error), .refused_o(refused));

  // The group: at rest, clock high, clock low.
  logic run_q = 1'b0, low_q = 1'b0;
  always @(posedge clk_i) begin
    if (start_i)      run_q <= 1'b1;
    else if (end_i)   run_q <= 1'b0;
    if (fall_i)       low_q <= 1'b1;
    else if (rise_i)  low_q <= 1'b0;
  end
  always_comb begin
    assume (!start_i || (rst_nq && !run_q));
    assume (!refuse_i || run_q);
    assume (!fall_i || (!low_q && !end_i && (run_q || start_i)));
    assume (!rise_i || low_q);
    assume (!end_i || (run_q && !low_q && !active));
    assume (bits_i >= 6'd12 && bits_i <= 6'd32);
    assume (!(odd_i && even_i));
  end

  // The clocks that its word has, as the trigger found it, and those that were.
  logic [5:0]  all_q = 6'd0, seen_q = 6'd0;
  logic        frame_q = 1'b0, whole_q = 1'b0, whole1_q = 1'b0, shot_q = 1'b0;
  logic [31:0] position_q = 32'h0;
  logic [7:0]  refused_q = 8'd0;
  always @(posedge clk_i) begin
    if (start_i && enable_i) begin
      all_q   <= bits_i + {5'd0, odd_i | even_i} + 6'd1;
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
    refused_q  <= refused_q + {7'd0, refuse_i & enable_i};
  end

  // From inside: the clocks left, a whole word.
  (* hierconn *) wire logic [5:0] \dut.rises_q ;
  (* hierconn *) wire logic       \dut.load_q ;

  always @(posedge clk_i) if (rst_nq) begin
    // L1: The design's count of clocks left and the one here of those that were make the whole.
    L1: assert (active == frame_q && (!frame_q || (\dut.rises_q == all_q - seen_q && seen_q < all_q)) &&
                (frame_q || seen_q == all_q) && (run_q || !frame_q) && (run_q || !low_q));

    // L2: A word is loaded when it has just become whole.
    L2: assert (\dut.load_q == whole_q);

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
  end

endmodule : ssi_channel_rules

`default_nettype wire
