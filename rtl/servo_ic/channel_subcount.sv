// Hardware 1/T: 12 fraction bits between two counts, e = floor(4096 * T2 / T1), at most 4095. After each count a
// restoring divider makes 4096 / T1 in 13 clk_ref cycles; from then on every SCLK period adds quotient and remainder to
// e, two periods at a time until the ones missed during the division are made up. Clock clk_ref_i; no reset: without
// enable_i each edge empties it.
`default_nettype none

module channel_subcount (
  input  wire logic        clk_ref_i,
  input  wire logic        enable_i,        // I7mn9, and the timers are not those of an MLDT
  input  wire logic        ce_i,            // SCLK
  input  wire logic        count_i,
  input  wire logic        reversed_i,      // this count reverses the direction: no estimate until the next one
  input  wire logic        down_i,          // direction of the last count
  input  wire logic        down_new_i,      // direction of this count
  input  wire logic [22:0] t1_i,
  output logic [11:0]      fraction_o,      // e, or 4095 - e when the last count was down
  output logic [11:0]      fraction_d_o     // after a count at this edge: start of the new cell
);

  localparam logic [3:0] Steps = 4'd13;  // of the division: a 1 followed by twelve 0s

  logic        valid_q;
  logic [3:0]  steps_q;             // division steps to go
  logic [12:0] quotient_q;
  logic [22:0] remainder_q, rest_q; // 4096 mod T1; 4096 * added periods mod T1
  logic [11:0] e_q;
  logic [4:0]  lag_q;               // SCLK periods not yet added

  logic        divides, fits, add, two, over;
  logic [22:0] rest;
  logic [23:0] shifted;
  logic [24:0] sum;
  logic [13:0] e_next;

  // One division step.
  assign divides = steps_q != 4'd0;
  assign shifted = {remainder_q, steps_q == Steps};
  assign fits    = shifted >= {1'b0, t1_i};

  // One or two SCLK periods more.
  assign add = valid_q & ~divides & (lag_q != 5'd0);
  assign two = lag_q > 5'd1;
  assign sum = {2'b00, rest_q} + (two ? {1'b0, remainder_q, 1'b0} : {2'b00, remainder_q});
  always_comb begin
    rest   = sum[22:0];
    e_next = {2'b00, e_q} + (two ? {quotient_q, 1'b0} : {1'b0, quotient_q});
    if (sum >= {1'b0, t1_i, 1'b0}) begin
      rest   = sum[22:0] - {t1_i[21:0], 1'b0};
      e_next = e_next + 14'd2;
    end else if (sum >= {2'b00, t1_i}) begin
      rest   = sum[22:0] - t1_i;
      e_next = e_next + 14'd1;
    end
  end
  assign over = |e_next[13:12];

  // A division shifts all of the quotient before it out.
  always_ff @(posedge clk_ref_i) begin
    if (count_i || !enable_i) begin
      valid_q     <= enable_i & count_i & ~reversed_i;
      steps_q     <= Steps;
      remainder_q <= 23'd0;
      rest_q      <= 23'd0;
      e_q         <= 12'd0;
      lag_q       <= 5'd0;
    end else begin
      if (divides) begin
        steps_q     <= steps_q - 4'd1;
        quotient_q  <= {quotient_q[11:0], fits};
        remainder_q <= fits ? shifted[22:0] - t1_i : shifted[22:0];
      end
      if (add) begin
        rest_q <= rest;
        e_q    <= over ? 12'hFFF : e_next[11:0];
      end
      lag_q <= lag_q - (add ? (two ? 5'd2 : 5'd1) : 5'd0) + {4'd0, ce_i};
    end
  end

  assign fraction_o   = down_i ? ~e_q : e_q;
  assign fraction_d_o = count_i ? {12{down_new_i}} : fraction_o;

endmodule : channel_subcount

`default_nettype wire
