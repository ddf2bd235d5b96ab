# first
behavior_name=Goto_list 	
<start:b_arg>
b_arg:num_legs_to_run( nodim )-1#x
b_arg: initial_wpt(enum) -07300.0  3850.2
b_arg: initial_wpt(enum) 007
b_arg: colour(nodim) ??
<end:b_arg>
<start:waypoints>
801 5400 | a
-118.5321 33.4210
3117.5 -17030.5
1 2 3
1
69696969 1e308
<end:waypoints>