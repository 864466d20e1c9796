// Hardware 1/T: 12 fraction bits between two counts, e = floor(4096 * T2 / T1), at most 4095. After each count a restoring
// divider makes 4096 / T1 in 13 clk_ref cycles; from then on every SCLK period adds quotient and remainder to e, two periods
// at a time until the ones missed during the division are made up. Clock clk_ref_i, asynchronous reset.
`default_nettype none

module channel_subcount (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        enable_i,        // I7mn9
  input  wire logic        ce_i,            // SCLK
  input  wire logic        count_i,
  input  wire logic        echo_i,          // MLDT changes T1: no estimate
  input  wire logic        reversed_i,      // this count reverses the direction: no estimate until the next one
  input  wire logic        down_i,          // direction of the last count
  input  wire logic        down_new_i,      // direction of this count
  input  wire logic [22:0] t1_i,
  output logic [11:0]      fraction_o,      // e, or 4095 - e when the last count was down
  output logic [11:0]      fraction_d_o     // after a count at this edge: start of the new cell
);

  logic        valid_q, full_q;
  logic [3:0]  steps_q;             // division steps to go
  logic [12:0] quotient_q, sum_e;
  logic [22:0] remainder_q, rest_q; // 4096 mod T1; 4096 * added periods mod T1
  logic [11:0] e_q;
  logic [4:0]  lag_q;               // SCLK periods not yet added

  // One division step: the dividend is a 1 followed by twelve 0s.
  logic [23:0] shifted, t1;
  logic        fits;
  assign t1      = {1'b0, t1_i};
  assign shifted = {remainder_q, steps_q == 4'd13};
  assign fits    = shifted >= t1;

  // One or two SCLK periods more.
  logic        add, two;
  logic [24:0] sum, rest;
  logic [13:0] e_next;
  always_comb begin
    add    = valid_q & (steps_q == 4'd0) & (lag_q != 5'd0);
    two    = lag_q > 5'd1;
    sum    = {2'b00, rest_q} + (two ? {1'b0, remainder_q, 1'b0} : {2'b00, remainder_q});
    sum_e  = {1'b0, e_q};
    rest   = sum;
    e_next = {1'b0, sum_e} + (two ? {quotient_q, 1'b0} : {1'b0, quotient_q});
    if (sum >= {1'b0, t1_i, 1'b0}) begin
      rest   = sum - {1'b0, t1_i, 1'b0};
      e_next = e_next + 14'd2;
    end else if (sum >= {1'b0, t1}) begin
      rest   = sum - {1'b0, t1};
      e_next = e_next + 14'd1;
    end
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q     <= 1'b0;
      full_q      <= 1'b0;
      steps_q     <= 4'd0;
      quotient_q  <= 13'd0;
      remainder_q <= 23'd0;
      rest_q      <= 23'd0;
      e_q         <= 12'd0;
      lag_q       <= 5'd0;
    end else if (count_i || echo_i || !enable_i) begin
      valid_q     <= enable_i & count_i & ~reversed_i;
      full_q      <= 1'b0;
      steps_q     <= 4'd13;
      quotient_q  <= 13'd0;
      remainder_q <= 23'd0;
      rest_q      <= 23'd0;
      e_q         <= 12'd0;
      lag_q       <= 5'd0;
    end else if (valid_q && !full_q) begin
      if (steps_q != 4'd0) begin
        steps_q     <= steps_q - 4'd1;
        quotient_q  <= {quotient_q[11:0], fits};
        remainder_q <= fits ? shifted[22:0] - t1_i : shifted[22:0];
      end
      if (add) begin
        rest_q <= rest[22:0];
        e_q    <= e_next > 14'd4095 ? 12'd4095 : e_next[11:0];
        full_q <= e_next > 14'd4095;
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
