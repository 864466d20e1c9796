// Hardware 1/T: 12 fraction bits between two counts, e = floor(4096 * T2 / T1), at most 4095. After each count a
// restoring divider makes 4096 / T1 in 13 clk_ref cycles; from then on every SCLK period adds quotient and remainder to
// e, two periods at a time until the ones missed during the division are made up. Clock clk_ref_i, asynchronous reset.
`default_nettype none

module channel_subcount (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
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

  localparam logic [3:0]  Steps = 4'd13;      // of the division: a 1 followed by twelve 0s
  localparam logic [13:0] Full  = 14'd4095;   // the largest e

  logic        valid_q, full_q;
  logic [3:0]  steps_q;             // division steps to go
  logic [12:0] quotient_q;
  logic [22:0] remainder_q, rest_q; // 4096 mod T1; 4096 * added periods mod T1
  logic [11:0] e_q;
  logic [4:0]  lag_q;               // SCLK periods not yet added

  logic        busy, fits, add, two;
  logic [23:0] shifted;
  logic [24:0] t1, sum, rest;
  logic [13:0] e_next;
  assign busy = valid_q & ~full_q;

  always_comb begin
    shifted = 24'd0;
    fits    = 1'b0;
    add     = 1'b0;
    two     = 1'b0;
    t1      = 25'd0;
    sum     = 25'd0;
    rest    = 25'd0;
    e_next  = 14'd0;
    if (busy) begin
      t1 = {2'b00, t1_i};
      if (steps_q != 4'd0) begin
        // One division step.
        shifted = {remainder_q, steps_q == Steps};
        fits    = {1'b0, shifted} >= t1;
      end else if (lag_q != 5'd0) begin
        // One or two SCLK periods more.
        add    = 1'b1;
        two    = lag_q > 5'd1;
        sum    = {2'b00, rest_q} + (two ? {1'b0, remainder_q, 1'b0} : {2'b00, remainder_q});
        rest   = sum;
        e_next = {2'b00, e_q} + (two ? {quotient_q, 1'b0} : {1'b0, quotient_q});
        if (sum >= {t1[23:0], 1'b0}) begin
          rest   = sum - {t1[23:0], 1'b0};
          e_next = e_next + 14'd2;
        end else if (sum >= t1) begin
          rest   = sum - t1;
          e_next = e_next + 14'd1;
        end
      end
    end
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q     <= 1'b0;
      full_q      <= 1'b0;
      steps_q     <= Steps;
      quotient_q  <= 13'd0;
      remainder_q <= 23'd0;
      rest_q      <= 23'd0;
      e_q         <= 12'd0;
      lag_q       <= 5'd0;
    end else if (count_i || !enable_i) begin
      valid_q     <= enable_i & count_i & ~reversed_i;
      full_q      <= 1'b0;
      steps_q     <= Steps;
      quotient_q  <= 13'd0;
      remainder_q <= 23'd0;
      rest_q      <= 23'd0;
      e_q         <= 12'd0;
      lag_q       <= 5'd0;
    end else if (busy) begin
      if (steps_q != 4'd0) begin
        steps_q     <= steps_q - 4'd1;
        quotient_q  <= {quotient_q[11:0], fits};
        remainder_q <= fits ? shifted[22:0] - t1_i : shifted[22:0];
      end
      if (add) begin
        rest_q <= rest[22:0];
        e_q    <= e_next > Full ? Full[11:0] : e_next[11:0];
        full_q <= e_next > Full;
      end
      lag_q <= lag_q - (add ? (two ? 5'd2 : 5'd1) : 5'd0) + {4'd0, ce_i};
    end
  end

  assign fraction_o   = down_i ? ~e_q : e_q;
  assign fraction_d_o = count_i ? {12{down_new_i}} : fraction_o;
  logic unused;
  assign unused = &{1'b0, rest[24:23]};

endmodule : channel_subcount

`default_nettype wire
