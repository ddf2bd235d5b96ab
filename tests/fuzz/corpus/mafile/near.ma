behavior_name=goto_list
<start:b_arg>
b_arg: num_legs_to_run(nodim) -1
b_arg: list_when_wpt_dist(m) 5000
b_arg: wpt_x_0(X) 1
<end:b_arg>
<start:waypoints>
-11836.0 3324.0
-118.6 33.4
3324.0 -11836.0
<end:waypoints>
