#include "daemon/cli/field_page.hpp"

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/cli/field_text.hpp"
#include "daemon/cli/markup.hpp"

namespace glidehelm::cli {

namespace {

using nlohmann::ordered_json;

/// Everything the page needs of the outside: nothing. No text of a file can load or run anything.
constexpr const char* kHead =
    R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width">
<style>
body{margin:0 auto;max-width:1100px;padding:12px;font:14px/1.4 system-ui,sans-serif;color:#1b2733;background:#fff}
h1{font-size:17px;margin:0 0 2px}p{margin:4px 0}.small{color:#51606e;font-size:12px}
#map{position:relative;margin:8px 0;border:1px solid #b9c4ce;background:#d9d4c8;touch-action:none}
#map canvas{position:absolute;left:0;top:0;width:100%;height:100%}
.row{display:flex;gap:10px;align-items:center;flex-wrap:wrap;margin:6px 0}
#slider{flex:1;min-width:160px}#time{font-variant-numeric:tabular-nums;min-width:13em}
button,select{font:inherit;padding:3px 10px}#read{font-variant-numeric:tabular-nums;min-height:1.4em}
#bar{width:240px;height:12px;border:1px solid #b9c4ce}
</style>
)";

constexpr const char* kBody = R"(<div class="row"><button id="play" aria-pressed="false">Play</button>
<input id="slider" type="range" min="0" step="0.01" value="0" aria-label="time"><span id="time"></span></div>
<div id="map"><canvas id="colours"></canvas><canvas id="moving"></canvas></div>
<div id="read" aria-live="off">Move the cursor over the map to read the current.</div>
<div class="row"><span>0</span><canvas id="bar" width="240" height="12"></canvas><span id="most"></span>
<label>show <select id="how"><option value="particles">particles</option><option value="arrows">arrows</option>
<option value="none">colours only</option></select></label>
<label>speed <select id="rate"><option value="0.5">slow</option><option value="1.5" selected>normal</option>
<option value="4">fast</option></select></label></div>
<p class="small">Particles and arrows move and point to where the water flows (“toward”, degrees clockwise from true north).
Particles show direction and relative speed; they run much faster than the water. Grey is land or no value. All times UTC.
Keys: space plays and pauses, left and right step a time, Home and End jump, a changes particles and arrows.</p>
)";

/// Draws. `F` is the document's data. Names: fx, fy a place in fractional columns and rows; ft a fractional time.
constexpr const char* kScript = R"JS(<script>
"use strict";
const F=JSON.parse(document.getElementById("data").textContent);
const $=id=>document.getElementById(id);
const raw=atob(F.values),bytes=new Uint8Array(raw.length);
for(let i=0;i<raw.length;i++)bytes[i]=raw.charCodeAt(i);
const view=new DataView(bytes.buffer),NO=-32768,rows=F.lats.length,cols=F.lons.length;
const V=new Int16Array(bytes.length/2);
for(let i=0;i<V.length;i++)V[i]=view.getInt16(2*i,true);
const frames=Math.max(1,F.times.length);
const west=F.lons[0],east=F.lons[cols-1],south=F.lats[0],north=F.lats[rows-1];
const squeeze=Math.cos((south+north)/2*Math.PI/180);
// One scale for both directions, as large as fits.
const wide=(east-west)*squeeze,high=north-south,scale=Math.min(1060/wide,680/high);
const W=Math.max(120,Math.round(wide*scale)),H=Math.max(80,Math.round(high*scale));
const x_of=lon=>(lon-west)/(east-west)*W,y_of=lat=>(north-lat)/(north-south)*H;
for(const id of["colours","moving"]){$(id).width=W;$(id).height=H}
$("map").style.width="100%";$("map").style.maxWidth=W+"px";$("map").style.aspectRatio=W+"/"+H;
function place(axis,value){
  if(!(value>=axis[0]&&value<=axis[axis.length-1]))return NaN;
  let low=0,up=axis.length-1;
  while(up-low>1){const m=(low+up)>>1;if(axis[m]<=value)low=m;else up=m}
  return low+(value-axis[low])/(axis[up]-axis[low]);
}
// Every pixel's column and row, because axes need not be even.
const column=new Float64Array(W),row=new Float64Array(H);
for(let x=0;x<W;x++)column[x]=place(F.lons,west+(x+0.5)/W*(east-west));
for(let y=0;y<H;y++)row[y]=place(F.lats,north-(y+0.5)/H*(north-south));
const out=[0,0];
// The mean of the wet corners if they hold half of the weight, as the planner takes it.
function plane(t,fx,fy){
  const i=Math.min(cols-2,Math.floor(fx)),j=Math.min(rows-2,Math.floor(fy)),a=fx-i,b=fy-j;
  let e=0,n=0,w=0;
  for(let c=0;c<4;c++){
    const k=2*((t*rows+j+(c>>1))*cols+i+(c&1));
    if(V[k]===NO)continue;
    const g=(c&1?a:1-a)*(c>>1?b:1-b);
    w+=g;e+=g*V[k];n+=g*V[k+1];
  }
  if(w<0.5)return false;
  out[0]=e/w/1000;out[1]=n/w/1000;return true;
}
function current(fx,fy,ft){
  if(!(fx>=0&&fy>=0))return false;
  const t=Math.min(frames-1,Math.floor(ft)),f=ft-t;
  if(!plane(t,fx,fy))return false;
  if(f===0||t+1>=frames)return true;
  const e=out[0],n=out[1];
  if(!plane(t+1,fx,fy))return false;
  out[0]=e+f*(out[0]-e);out[1]=n+f*(out[1]-n);return true;
}
let fastest=0.05;
for(let k=0;k<V.length;k+=2)if(V[k]!==NO)fastest=Math.max(fastest,Math.hypot(V[k],V[k+1])/1000);
const stops=[[24,45,92],[33,113,181],[44,162,149],[161,204,90],[250,210,70],[226,90,40]];
const lut=[];
for(let k=0;k<256;k++){
  const p=k/255*(stops.length-1),i=Math.min(stops.length-2,Math.floor(p)),f=p-i;
  lut.push(stops[i].map((c,q)=>Math.round(c+f*(stops[i+1][q]-c))));
}
const colours=$("colours").getContext("2d"),moving=$("moving").getContext("2d");
const image=colours.createImageData(W,H);
function shore(){
  colours.strokeStyle="#333";colours.lineWidth=1;
  for(const line of F.shores){
    colours.beginPath();
    line.forEach((p,k)=>k?colours.lineTo(x_of(p[0]),y_of(p[1])):colours.moveTo(x_of(p[0]),y_of(p[1])));
    colours.stroke();
  }
}
function paint(ft){
  const d=image.data;
  for(let y=0,k=0;y<H;y++)for(let x=0;x<W;x++,k+=4){
    if(!current(column[x],row[y],ft)){d[k+3]=0;continue}
    const c=lut[Math.min(255,Math.floor(Math.hypot(out[0],out[1])/fastest*255))];
    d[k]=c[0];d[k+1]=c[1];d[k+2]=c[2];d[k+3]=255;
  }
  colours.putImageData(image,0,0);shore();
}
function arrows(ft){
  moving.clearRect(0,0,W,H);moving.strokeStyle="rgba(255,255,255,.9)";moving.lineWidth=1.2;
  const gap=28;
  for(let y=gap/2;y<H;y+=gap)for(let x=gap/2;x<W;x+=gap){
    if(!current(column[x|0],row[y|0],ft))continue;
    const s=Math.hypot(out[0],out[1]);
    if(s<1e-3)continue;
    const l=Math.max(4,gap*0.95*s/fastest),dx=out[0]/s,dy=-out[1]/s,tx=x+dx*l/2,ty=y+dy*l/2,h=Math.min(6,l/2);
    moving.beginPath();moving.moveTo(x-dx*l/2,y-dy*l/2);moving.lineTo(tx,ty);
    moving.moveTo(tx-h*(dx+0.6*dy),ty-h*(dy-0.6*dx));moving.lineTo(tx,ty);
    moving.lineTo(tx-h*(dx-0.6*dy),ty-h*(dy+0.6*dx));moving.stroke();
  }
}
// A generator of our own: the page moves alike wherever it is opened.
let seed=1;
const random=()=>(seed=(seed*48271)%2147483647)/2147483647;
const particles=[];
for(let k=0;k<Math.min(2500,Math.round(W*H/250));k++)particles.push({x:random()*W,y:random()*H,age:Math.floor(random()*90)});
function drift(ft){
  moving.globalCompositeOperation="destination-in";moving.fillStyle="rgba(0,0,0,.93)";moving.fillRect(0,0,W,H);
  moving.globalCompositeOperation="source-over";moving.strokeStyle="rgba(255,255,255,.85)";moving.lineWidth=1.1;
  moving.beginPath();
  for(const p of particles){
    const inside=p.age-->0&&p.x>=0&&p.y>=0&&p.x<W&&p.y<H;
    if(!inside||!current(column[p.x|0],row[p.y|0],ft)){p.x=random()*W;p.y=random()*H;p.age=30+Math.floor(random()*60);continue}
    moving.moveTo(p.x,p.y);
    p.x+=2.2*out[0]/fastest;p.y-=2.2*out[1]/fastest;
    moving.lineTo(p.x,p.y);
  }
  moving.stroke();
}
let at=0,playing=false,before=0,painted=-1;
const slider=$("slider");
slider.max=frames-1;
function time_text(ft){
  if(!F.times.length)return"the same at every time";
  const t=Math.min(frames-1,Math.floor(ft)),f=ft-t,a=F.times[t],b=F.times[Math.min(frames-1,t+1)];
  return new Date(1000*(a+f*(b-a))).toISOString().slice(0,16).replace("T"," ")+" UTC";
}
function show(){
  if(at!==painted){paint(at);painted=at}
  slider.value=at;$("time").textContent=time_text(at);
  if($("how").value==="arrows")arrows(at);
  read();
}
function play(on){
  playing=on;$("play").textContent=on?"Pause":"Play";$("play").setAttribute("aria-pressed",on);
}
function tick(now){
  const passed=Math.min(0.1,(now-before)/1000);before=now;
  if(playing){
    if(frames>1){at+=passed*Number($("rate").value);if(at>frames-1)at=0}
    if($("how").value==="particles")drift(at);
    show();
  }
  requestAnimationFrame(tick);
}
let cursor=null;
function read(){
  if(!cursor)return;
  const lon=west+cursor.x*(east-west),lat=north-cursor.y*(north-south);
  let text=lat.toFixed(3)+"°, "+(lon>180?lon-360:lon).toFixed(3)+"°: ";
  if(current(place(F.lons,lon),place(F.lats,lat),at)){
    const toward=(Math.atan2(out[0],out[1])*180/Math.PI+360)%360;
    text+=Math.hypot(out[0],out[1]).toFixed(3)+" m/s toward "+(Math.round(toward)%360)+"° (east "+out[0].toFixed(3)+", north "+
      out[1].toFixed(3)+")";
  }else text+="land or no value";
  $("read").textContent=text;
}
$("map").addEventListener("pointermove",e=>{
  const box=$("map").getBoundingClientRect();
  cursor={x:(e.clientX-box.left)/box.width,y:(e.clientY-box.top)/box.height};read();
});
$("play").addEventListener("click",()=>play(!playing));
slider.addEventListener("input",()=>{play(false);at=Number(slider.value);show()});
$("how").addEventListener("change",()=>{moving.clearRect(0,0,W,H);show()});
function jump(to){play(false);at=Math.min(frames-1,Math.max(0,to));show()}
document.addEventListener("keydown",e=>{
  if(e.target.tagName==="SELECT")return;
  if(e.key===" ")play(!playing);
  else if(e.key==="ArrowRight")jump(Math.floor(at)+1);
  else if(e.key==="ArrowLeft")jump(Math.ceil(at)-1);
  else if(e.key==="Home")jump(0);
  else if(e.key==="End")jump(frames-1);
  else if(e.key==="a"){$("how").value=$("how").value==="arrows"?"particles":"arrows";moving.clearRect(0,0,W,H);show()}
  else return;
  e.preventDefault();
});
const bar=$("bar").getContext("2d");
for(let k=0;k<240;k++){bar.fillStyle="rgb("+lut[Math.floor(k/239*255)].join(",")+")";bar.fillRect(k,0,1,12)}
$("most").textContent=fastest.toFixed(2)+" m/s";
show();
play(!window.matchMedia("(prefers-reduced-motion: reduce)").matches);
requestAnimationFrame(tick);
</script></body></html>
)JS";

/// Base64 of the values, each two bytes, the lower first.
std::string base64(const std::vector<std::int16_t>& values) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(values.size() * 8 / 3 + 4);
  const std::size_t bytes = 2 * values.size();
  const auto byte = [&](std::size_t k) -> unsigned {
    return k < bytes ? (static_cast<unsigned>(std::bit_cast<std::uint16_t>(values[k / 2])) >> (k % 2 * 8)) & 0xFFU : 0U;
  };
  for (std::size_t k = 0; k < bytes; k += 3) {
    const unsigned three = byte(k) << 16U | byte(k + 1) << 8U | byte(k + 2);
    text += kDigits[three >> 18U];
    text += kDigits[(three >> 12U) & 63U];
    text += k + 1 < bytes ? kDigits[(three >> 6U) & 63U] : '=';
    text += k + 2 < bytes ? kDigits[three & 63U] : '=';
  }
  return text;
}

double rounded(double degrees) { return std::round(degrees * 1e5) / 1e5; }

/// Numbers only; "<" cannot stand in them, so nothing ends the element early.
ordered_json data_of(const Animation& a) {
  ordered_json shores = ordered_json::array();
  for (const auto& line : a.shores) {
    ordered_json points = ordered_json::array();
    for (const auto& [lon, lat] : line) points.push_back({rounded(lon), rounded(lat)});
    shores.push_back(std::move(points));
  }
  return {{"times", a.times_s},
          {"lats", a.lats_deg},
          {"lons", a.lons_deg},
          {"shores", std::move(shores)},
          {"values", base64(a.mm_per_s)}};
}

}  // namespace

std::string animation_page(const Animation& a) {
  std::string text = kHead;
  text += "<title>" + escaped(a.title) + "</title></head><body>\n<h1>" + escaped(a.title) + "</h1>\n<p>Current" +
          (a.depth_text.empty() ? "" : " at " + escaped(a.depth_text)) + ", m/s." +
          (a.decimation.empty() ? "" : " To keep the page small " + escaped(a.decimation) + ".") + "</p>\n";
  text += kBody;
  for (const auto& warning : a.warnings) text += "<p class=\"small\">Warning: " + escaped(warning) + "</p>\n";
  return text + "<script type=\"application/json\" id=\"data\">" + data_of(a).dump() + "</script>\n" + kScript;
}

}  // namespace glidehelm::cli
