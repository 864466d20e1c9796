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
  logic [3:0]  steps_q;                  // division steps to go
  logic [12:0] quotient_q, remainder_q;  // 4096 / T1, 4096 mod T1
  logic [22:0] rest_q;                   // 4096 * added periods mod T1
  logic [11:0] e_q;
  logic [4:0]  lag_q;                    // SCLK periods not yet added

  logic        divides, fits, add, two, over;
  logic [1:0]  carry;
  logic [22:0] rest;
  logic [12:0] shifted;
  logic [23:0] less, sum;
  logic [24:0] once, twice;  // the highest bit of a difference is its borrow
  logic [13:0] e_next;

  // One division step.
  assign divides = steps_q != 4'd0;
  assign shifted = {remainder_q[11:0], steps_q == Steps};
  assign less    = {11'd0, shifted} - {1'b0, t1_i};
  assign fits    = ~less[23];

  // One or two SCLK periods more.
  assign add   = valid_q & ~divides & (lag_q != 5'd0);
  assign two   = lag_q > 5'd1;
  assign sum   = {1'b0, rest_q} + (two ? {10'd0, remainder_q, 1'b0} : {11'd0, remainder_q});
  assign once  = {1'b0, sum} - {2'b00, t1_i};
  assign twice = {1'b0, sum} - {1'b0, t1_i, 1'b0};
  always_comb begin
    rest  = sum[22:0];
    carry = 2'd0;
    if (!twice[24]) begin
      rest  = twice[22:0];
      carry = 2'd2;
    end else if (!once[24]) begin
      rest  = once[22:0];
      carry = 2'd1;
    end
  end
  assign e_next = {2'b00, e_q} + (two ? {quotient_q, 1'b0} : {1'b0, quotient_q}) + {12'd0, carry};
  assign over = |e_next[13:12];

  // A division shifts all of the quotient before it out.
  always_ff @(posedge clk_ref_i) begin
    if (count_i || !enable_i) begin
      valid_q     <= enable_i & count_i & ~reversed_i;
      steps_q     <= Steps;
      remainder_q <= 13'd0;
      rest_q      <= 23'd0;
      e_q         <= 12'd0;
      lag_q       <= 5'd0;
    end else begin
      if (divides) begin
        steps_q     <= steps_q - 4'd1;
        quotient_q  <= {quotient_q[11:0], fits};
        remainder_q <= fits ? less[12:0] : shifted;
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
  logic unused;  // of a difference that is not negative: as wide as what it is of, or below T1
  assign unused = &{1'b0, less[22:13], once[23], twice[23]};

endmodule : channel_subcount

`default_nettype wire
