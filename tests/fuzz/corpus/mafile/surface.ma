behavior_name=surface
<start:b_arg>
 b_arg: start_when(enum) 12 # BAW_NOCOMM_SECS
 b_arg: when_secs(sec) 60
 b_arg: c_thruster_value(X) -.05
 b_arg: heading_value(X) 1000000
<end:b_arg>
