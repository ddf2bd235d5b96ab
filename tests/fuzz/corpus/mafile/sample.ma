behavior_name=sample
<start:b_arg>
b_arg: sensor_type(enum) 1
b_arg: state_to_sample(enum) 15
b_arg: intersample_time(s) 0
b_arg: max_depth(m) 1e7
<end:b_arg>
