behavior_name=yo
# made up
<start:b_arg>
  b_arg: start_when(enum) 2
  b_arg: d_target_depth(m) 200
  b_arg: c_target_depth(m) 220 # below
  b_arg: d_use_pitch(enum) 3
  b_arg: d_pitch_value(X) -26
  b_arg: c_pitch_value(X) 0.4538
  b_arg: target_depth(m) 100
  b_arg: d_bpump_value(X) -1e3
<end:b_arg>
