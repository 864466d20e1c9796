// Serial data of one DAC: 18 bits of the command, bit 23 first, in step with the common strobe. Clock clk_ref_i,
// asynchronous reset. docs/servo_channel.md, Serial DAC and ADC.
`default_nettype none

module channel_dac (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        load_i,
  input  wire logic        shift_i,
  input  wire logic [17:0] command_i,
  output logic             data_o
);

  logic        data_q;
  logic [16:0] word_q;  // the bits behind it: none comes out before a word is loaded
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni)      data_q <= 1'b0;
    else if (load_i)  data_q <= command_i[17];
    else if (shift_i) data_q <= word_q[16];
  end

  always_ff @(posedge clk_ref_i) begin
    if (load_i)       word_q <= command_i[16:0];
    else if (shift_i) word_q <= {word_q[15:0], 1'b0};
  end
  assign data_o = data_q;

endmodule : channel_dac

`default_nettype wire
